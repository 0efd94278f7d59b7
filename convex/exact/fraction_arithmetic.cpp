#include "convex/exact/fraction_arithmetic.hpp"

#include <cmath>
#include <limits>

#include "convex/exact/elimination.hpp"

namespace convex {

Fraction lowest_terms(Fraction a) {
  if (a.denominator == 1) return a;
  const Integer common = greatest_common_divisor(a.numerator, a.denominator);
  if (common == 1) return a;
  return {exact_quotient(a.numerator, common), exact_quotient(a.denominator, common)};
}

Fraction entry(const ExactVector& x, std::size_t i) { return lowest_terms({x.numerators[i], x.denominator}); }

Fraction operator+(const Fraction& a, const Fraction& b) {
  if (a.denominator == b.denominator) return lowest_terms({a.numerator + b.numerator, a.denominator});
  return lowest_terms(
      {a.numerator * b.denominator + b.numerator * a.denominator, a.denominator * b.denominator});
}
Fraction operator-(const Fraction& a) { return {-a.numerator, a.denominator}; }
Fraction operator-(const Fraction& a, const Fraction& b) { return a + -b; }
Fraction operator*(const Fraction& a, const Fraction& b) {
  return lowest_terms({a.numerator * b.numerator, a.denominator * b.denominator});
}
Fraction operator/(const Fraction& a, const Fraction& b) {
  const Fraction inverse =
      b.numerator.sign() < 0 ? Fraction{-b.denominator, -b.numerator} : Fraction{b.denominator, b.numerator};
  return a * inverse;
}

bool operator==(const Fraction& a, const Fraction& b) {
  return a.numerator * b.denominator == b.numerator * a.denominator;
}
bool operator<(const Fraction& a, const Fraction& b) {
  return a.numerator * b.denominator < b.numerator * a.denominator;
}

std::string text(const Fraction& a) {
  const Fraction lowest = lowest_terms(a);
  return lowest.denominator == 1 ? lowest.numerator.text()
                                 : lowest.numerator.text() + "/" + lowest.denominator.text();
}

Fraction dot(const ExactVector& x, const ExactVector& y) {
  return {dot(x.numerators, y.numerators), x.denominator * y.denominator};
}

double root_above(const Fraction& a) {
  if (a.numerator.is_zero()) return 0;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  // sqrt(a) = sqrt(a 4^shift) 2^-shift with the number under the root well inside the doubles.
  const long exponent = static_cast<long>(a.numerator.bits()) - static_cast<long>(a.denominator.bits());
  const long shift = -exponent / 2;
  const auto power = Integer::shifted(1, static_cast<unsigned long>(2 * std::abs(shift)));
  const double near = shift >= 0 ? nearest_quotient(a.numerator * power, a.denominator)
                                 : nearest_quotient(a.numerator, a.denominator * power);
  constexpr long beyond = 100000;
  double root = std::ldexp(std::nextafter(std::sqrt(std::nextafter(near, infinity)), infinity),
                           static_cast<int>(std::min(std::max(-shift, -beyond), beyond)));
  if (!std::isfinite(root)) return infinity;
  return std::nextafter(root, infinity);
}

}  // namespace convex
