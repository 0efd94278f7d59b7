#include "convex/proved_prox/ball_numbers.hpp"

#include <cmath>

#include "convex/invariant.hpp"

namespace convex::inline proved_prox {
namespace {

/// The part by which witnesses are pulled away from a boundary.
const Fraction little{1, Integer::shifted(1, 250)};

/// Rounded to `witness_bits`, towards 0.
Fraction shortened(const Fraction& a) {
  if (sign(a) == 0) return a;
  const long excess = static_cast<long>(a.numerator.bits()) - static_cast<long>(a.denominator.bits());
  const long shift = witness_bits - excess;  // |a| 2^shift has so many bits before the point
  const auto power = Integer::shifted(1, static_cast<unsigned long>(std::abs(shift)));
  if (shift >= 0) return lowest_terms({truncated_quotient(a.numerator * power, a.denominator), power});
  return {truncated_quotient(a.numerator, a.denominator * power) * power, 1};
}

}  // namespace

std::optional<FractionInterval> interval(const Ball& a) {
  if (!a.is_finite() || !std::isfinite(a.radius())) return std::nullopt;
  const Fraction middle = a.midpoint(), radius = fraction(a.radius());
  return FractionInterval{middle - radius, middle + radius};
}

std::optional<Fraction> near(const Ball& a) {
  if (!a.is_finite() || !std::isfinite(a.radius())) return std::nullopt;
  return shortened(a.midpoint());
}

Fraction a_little_below(const Ball& positive) {
  const auto at = interval(positive);
  invariant(at.has_value(), "a witness is made of finite numbers");
  return shortened(at->low * (Fraction{1} - little));
}

Fraction a_little_above(const Ball& positive) {
  const auto at = interval(positive);
  invariant(at.has_value(), "a witness is made of finite numbers");
  return shortened(at->high * (Fraction{1} + little * Fraction{4}));
}

FractionInterval operator+(const FractionInterval& a, const FractionInterval& b) {
  return {a.low + b.low, a.high + b.high};
}

FractionInterval times(const Fraction& factor, const FractionInterval& a) {
  return {factor * a.low, factor * a.high};
}

}  // namespace convex::inline proved_prox
