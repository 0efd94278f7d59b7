#pragma once

#include <optional>
#include <string>

#include "convex/exact/fraction_arithmetic.hpp"

namespace convex::symbolic {

/// a + b sqrt(c), a and b fractions, c a whole number that is no square, or 0 with b: the numbers at which
/// parabolas with coefficients in fractions meet. Arithmetic stays in the field of one root.
class Surd {
 public:
  Surd() = default;
  Surd(Fraction a) : a_(std::move(a)) {}  // NOLINT: a fraction is one

  /// sqrt(a), a >= 0.
  static Surd root_of(const Fraction& a);

  const Fraction& rational_part() const { return a_; }
  /// b, and c.
  const Fraction& root_part() const { return b_; }
  const Integer& radicand() const { return c_; }
  bool is_rational() const { return convex::sign(b_) == 0; }

  /// Each throws InvalidInput where the operands hold two roots that are no multiples of each other.
  friend Surd operator+(const Surd& x, const Surd& y);
  friend Surd operator-(const Surd& x, const Surd& y);
  friend Surd operator*(const Surd& x, const Surd& y);
  /// y is not 0.
  friend Surd operator/(const Surd& x, const Surd& y);
  friend Surd operator-(const Surd& x);

 private:
  Surd(Fraction a, Fraction b, Integer c);
  Fraction a_{0, 1}, b_{0, 1};
  Integer c_ = 0;
};

int sign(const Surd& x);
bool operator==(const Surd& x, const Surd& y);
bool operator<(const Surd& x, const Surd& y);
double nearest_double(const Surd& x);

/// "(1 + 2*sqrt(5))/3", or as `convex::text` of a fraction; the same for LaTeX.
std::string text(const Surd& x);
std::string latex(const Surd& x);

/// The fraction; throws InvalidInput when it is none.
Fraction rational(const Surd& x);
std::optional<Fraction> rational(const std::optional<Surd>& x);

}  // namespace convex::symbolic
