#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convex/symbolic/surd.hpp"

namespace convex::symbolic {

/// A formula in one variable: a number, the variable, a sum, a product, a power, a function of other terms
/// (exp, log, sqrt, abs, sign, W: Lambert's function on [0, inf)), or a root: the u with parts[0] = parts[1],
/// parts[0] an increasing term in u alone, u above `lowest` where there is one.
struct Term {
  enum class Kind { number, variable, sum, product, power, function, root };
  Kind kind = Kind::number;
  Fraction number = {0, 1};
  std::string name = {};
  std::vector<Term> parts = {};
  std::optional<Fraction> lowest = {};
};

Term number(const Fraction&);
Term number(int);
/// a + b sqrt(c).
Term number(const Surd&);
Term variable(const std::string& name);
Term operator+(const Term&, const Term&);
Term operator-(const Term&, const Term&);
Term operator*(const Term&, const Term&);
Term operator*(const Fraction&, const Term&);
Term operator*(const Surd&, const Term&);
Term power(const Term&, const Fraction& exponent);
Term function(const std::string& name, const Term& argument);
Term root(const Term& increasing, const Term& target, std::optional<Fraction> lowest);

bool is_number(const Term&, const Fraction&);

/// The term with another in place of the variable of that name.
Term substituted(const Term&, const std::string& name, const Term& by);

/// Its derivative by the variable of that name; none where it holds a root or Lambert's function.
std::optional<Term> derivative(const Term&, const std::string& name);

/// At a value of the variable of that name; roots by bisection to the last digits.
double evaluate(const Term&, const std::string& name, double at);

/// "x^2/2 + 3*x", as problem files write expressions; "the u with u + exp(u) = z".
std::string text(const Term&);
std::string latex(const Term&);

/// The end of an interval: a + b sqrt(c), or a term without a variable, such as log(2) + 1.
class Bound {
 public:
  Bound(Surd value) : surd_(std::move(value)) {}      // NOLINT: a surd is one
  Bound(Fraction value) : surd_(std::move(value)) {}  // NOLINT
  explicit Bound(Term value);
  const std::optional<Surd>& surd() const { return surd_; }
  Term term() const { return surd_ ? number(*surd_) : term_; }

  friend Bound operator-(const Bound& a, const Fraction& b) { return a.less(b); }
  friend Bound operator/(const Bound& a, const Fraction& b) { return a.over(b); }
  /// Exact for surds; other terms are equal when they are written alike, and else in the order of their
  /// doubles. Throws InvalidInput where these do not tell.
  friend bool operator==(const Bound& a, const Bound& b) { return a.equals(b); }
  friend bool operator<(const Bound& a, const Bound& b) { return a.is_below(b); }

 private:
  Bound less(const Fraction&) const;
  Bound over(const Fraction&) const;
  bool equals(const Bound&) const;
  bool is_below(const Bound&) const;
  std::optional<Surd> surd_;
  Term term_;
};
double nearest_double(const Bound&);
std::string text(const Bound&);
std::string latex(const Bound&);
Fraction rational(const Bound&);
std::optional<Fraction> rational(const std::optional<Bound>&);

/// A formula on an interval; no bound: infinite. Where an end is left out another case tells.
struct Case {
  std::optional<Bound> low, high;
  bool has_low = true, has_high = true;
  Term term;
};

/// A function by cases, in increasing order; elsewhere it is +inf.
using Cases = std::vector<Case>;

/// The part of the cases between two ends, which belong to it.
Cases restricted(const Cases&, const std::optional<Bound>& low, const std::optional<Bound>& high);

/// The value at a point, +inf outside of all cases.
double evaluate(const Cases&, const std::string& name, double at);

}  // namespace convex::symbolic
