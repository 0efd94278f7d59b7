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

/// A formula on an interval; no bound: infinite. Where an end is left out another case tells.
struct Case {
  std::optional<Surd> low, high;
  bool has_low = true, has_high = true;
  Term term;
};

/// A function by cases, in increasing order; elsewhere it is +inf.
using Cases = std::vector<Case>;

/// The value at a point, +inf outside of all cases.
double evaluate(const Cases&, const std::string& name, double at);

}  // namespace convex::symbolic
