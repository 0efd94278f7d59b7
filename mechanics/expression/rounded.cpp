#include "mechanics/expression/rounded.hpp"

#include "convex/infinity.hpp"

namespace mechanics::expression {
namespace {

using convex::infinity;

/// f(a) with what the operand's radius moves it by, and what the function may be off.
Rounded moved(double f, double by) {
  return {f, widened(by + function_rounding * std::abs(f) +
                     (f != 0 && std::abs(f) < smallest_product ? lost_below : 0))};
}

/// The value at an operand where it is exact.
bool is_exactly(Rounded a, double number) { return a.value == number && a.is_exact(); }

}  // namespace

// Each bound is that of the mean value theorem, with the largest slope within the radius r; `widened` covers
// what the bound itself rounds.

Rounded sin(Rounded a) {
  const double r = a.radius;
  return moved(std::sin(a.value), r == 0 ? 0 : std::min(2.0, r * std::abs(std::cos(a.value)) + r * r));
}

Rounded cos(Rounded a) {
  if (is_exactly(a, 0)) return 1;
  const double r = a.radius;
  return moved(std::cos(a.value), r == 0 ? 0 : std::min(2.0, r * std::abs(std::sin(a.value)) + r * r));
}

/// tan(a + r) - tan a = (1 + tan²a) tan r / (1 - tan a tan r).
Rounded tan(Rounded a) {
  const double f = std::tan(a.value), r = a.radius;
  if (r == 0) return moved(f, 0);
  const double t = r < 1 ? std::tan(r) : infinity, rest = 1 - std::abs(f) * t;
  return moved(f, rest > 0 ? (1 + f * f) * t / rest : infinity);
}

/// The largest slope of asin within the radius.
namespace {
double slope_of_asin(Rounded a) {
  const double most = std::abs(a.value) + a.radius;
  return most < 1 ? 1 / std::sqrt((1 - most) * (1 + most)) : infinity;
}
}  // namespace

Rounded asin(Rounded a) { return moved(std::asin(a.value), a.radius == 0 ? 0 : a.radius * slope_of_asin(a)); }
Rounded acos(Rounded a) { return moved(std::acos(a.value), a.radius == 0 ? 0 : a.radius * slope_of_asin(a)); }

Rounded atan(Rounded a) {
  const double least = std::max(0.0, std::abs(a.value) - a.radius);
  return moved(std::atan(a.value), a.radius / (1 + least * least));
}

double atan2(double y, double x) { return std::atan2(y + 0.0, x + 0.0); }

/// Seen from 0, a disc of radius ρ at the distance R is within the angle asin(ρ/R) <= ρ/sqrt(R² - ρ²).
Rounded atan2(Rounded a, Rounded b) {
  const double f = atan2(a.value, b.value);
  if (a.is_exact() && b.is_exact()) return moved(f, 0);
  const double disc = std::hypot(a.radius, b.radius), distance = std::hypot(a.value, b.value);
  const bool may_jump = a.may_be_zero() && !a.is_exact() && b.value - b.radius <= 0;
  if (may_jump || !(disc < distance)) return moved(f, infinity);
  return moved(f, disc / std::sqrt((distance - disc) * (distance + disc)));
}

Rounded sinh(Rounded a) {
  return moved(std::sinh(a.value), a.radius == 0 ? 0 : a.radius * std::cosh(std::abs(a.value) + a.radius));
}

Rounded cosh(Rounded a) {
  if (is_exactly(a, 0)) return 1;
  return moved(std::cosh(a.value), a.radius == 0 ? 0 : a.radius * std::sinh(std::abs(a.value) + a.radius));
}

Rounded tanh(Rounded a) {
  if (a.radius == 0) return moved(std::tanh(a.value), 0);
  const double flattest = std::cosh(std::max(0.0, std::abs(a.value) - a.radius));
  return moved(std::tanh(a.value), a.radius / flattest / flattest);
}

Rounded exp(Rounded a) {
  if (is_exactly(a, 0)) return 1;
  const double f = std::exp(a.value);
  return moved(f, a.radius == 0 ? 0 : f * std::expm1(a.radius));
}

Rounded log(Rounded a) {
  const double f = std::log(a.value);
  if (a.radius == 0) return moved(f, 0);
  if (!(a.radius < a.value)) return moved(f, infinity);
  return moved(f, a.radius / (a.value - a.radius));
}

/// The root itself is rounded by |a - f²|/(f + sqrt a), a - f² exact.
Rounded sqrt(Rounded a) {
  const double f = std::sqrt(a.value);
  if (is_exactly(a, 0)) return 0;
  if (!(a.radius < a.value))
    return {f, a.radius >= 0 ? widened(f + std::sqrt(std::abs(a.value) + a.radius)) : infinity};
  double by = std::abs(std::fma(-f, f, a.value)) / f / (2 - 0x1p-50);
  if (a.radius > 0) by += a.radius / (f + std::sqrt(a.value - a.radius));
  return {f, widened(by)};
}

Rounded abs(Rounded a) { return {std::abs(a.value), a.radius}; }

Rounded hypot(Rounded a, Rounded b) {
  const double move = a.is_exact() && b.is_exact() ? 0 : std::hypot(a.radius, b.radius);
  return moved(std::hypot(a.value, b.value), move);
}

/// |a^b| = exp(b log|a|), whose exponent moves by |b| δ + |log|a|| r + δ r with δ the move of log|a|.
Rounded pow(Rounded a, Rounded b) {
  if (is_exactly(b, 0)) return 1;
  if (is_exactly(b, 1)) return a;
  const double f = std::pow(a.value, b.value);
  const double least = std::abs(a.value) - a.radius;
  if (a.is_exact() && b.is_exact()) {
    constexpr double most_factors = 64;
    const double factors = std::abs(b.value);
    if (factors > most_factors || factors != std::floor(factors)) return moved(f, 0);
    Rounded product = 1;  // an exact power is seen to be one
    for (double k = 0; k < factors; ++k) product = product * a;
    if (b.value < 0) product = Rounded(1) / product;
    return product.is_exact() && product.value == f ? product : moved(f, 0);
  }
  if (!(least > 0)) {
    const bool stays_small = b.is_exact() && b.value > 0;
    return moved(f, stays_small ? std::abs(f) + std::pow(std::abs(a.value) + a.radius, b.value) : infinity);
  }
  const double by_base = a.radius / least, logarithm = std::abs(std::log(std::abs(a.value)));
  const double exponent = std::abs(b.value) * by_base + b.radius * (logarithm + by_base);
  return moved(f, std::abs(f) * std::expm1(exponent));
}

}  // namespace mechanics::expression
