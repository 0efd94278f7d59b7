#include "convex/exact/fraction_arithmetic.hpp"

#include <cmath>
#include <limits>

#include "convex/exact/elimination.hpp"
#include "convex/infinity.hpp"

namespace convex::inline exact_arithmetic {

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

std::string decimal_text(const Fraction& a, int digits) {
  if (a.numerator.is_zero()) return "0";
  const Integer p = a.numerator.sign() < 0 ? -a.numerator : a.numerator;
  const auto power = [](long exponent) {
    return Integer::from_digits("1" + std::string(static_cast<std::size_t>(exponent), '0'));
  };
  // |a| 10^shift to the nearest integer.
  const auto scaled = [&](long shift) {
    const Integer top = shift >= 0 ? p * power(shift) : p;
    const Integer bottom = shift >= 0 ? a.denominator : a.denominator * power(-shift);
    return truncated_quotient(top + top + bottom, bottom + bottom).text();
  };
  constexpr double digits_of_a_bit = 0.30103;
  const double magnitude =
      digits_of_a_bit * (static_cast<double>(p.bits()) - static_cast<double>(a.denominator.bits()));
  long shift = digits + 1 - static_cast<long>(std::floor(magnitude));
  std::string text = scaled(shift);
  shift -= static_cast<long>(text.size()) - digits;
  text = scaled(shift);
  const long exponent = static_cast<long>(text.size()) - 1 - shift;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.size() > 1) text.insert(1, ".");
  return (a.numerator.sign() < 0 ? "-" : "") + text + (exponent == 0 ? "" : "e" + std::to_string(exponent));
}

Fraction dot(const ExactVector& x, const ExactVector& y) {
  return {dot(x.numerators, y.numerators), x.denominator * y.denominator};
}

double root_above(const Fraction& a) {
  if (a.numerator.is_zero()) return 0;
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

}  // namespace convex::inline exact_arithmetic
