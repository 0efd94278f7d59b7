#include "convex/prox_formulas/power.hpp"

#include <algorithm>
#include <string>

#include "convex/double_double.hpp"
#include "convex/invalid_input.hpp"

namespace convex::prox_formulas {

namespace {

/// An exponent with the digits that a double loses; they count for numbers far from 1.
using Exponent = DoubleDouble;

Exponent reciprocal(Exponent m) {
  const double r = 1 / m.hi;
  return {r, (std::fma(-r, m.hi, 1.0) - r * m.lo) * r};
}

/// rho u^m, for u > 0; u^m itself may overflow.
double power_term(double rho, double u, Exponent m) {
  const double half = std::pow(u, m.hi / 2);
  const double term = half * rho * half;
  return m.lo < 0 || m.lo > 0 ? term * (1 + m.lo * std::log(u)) : term;
}

/// Newton's method in log u for F, convex and increasing in log u, from above: u falls to the root. F(u)
/// returns {value, derivative by log u}, the value with an error of few roundings.
template <class Function>
double fall_to_root(Function F, double u) {
  for (double last = std::numeric_limits<double>::infinity(); u > 0;) {
    const auto [value, slope] = F(u);
    u *= std::exp(-value / slope);
    if (std::abs(value) <= 8 * unit_roundoff || !(std::abs(value) < last)) break;
    last = std::abs(value);
  }
  return u;
}

/// u >= 0 with u + rho u^q = z, for z > 0, and du/dz. Either term alone bounds u from above, within a factor
/// of two of the sum.
ScalarProx root_of_sum(double z, double rho, Exponent q) {
  const double start = std::min(z, std::exp((std::log(z) - std::log(rho)) / q.hi));
  const double u = fall_to_root(
      [&](double x) {
        const double term = power_term(rho, x, q);
        return std::pair{std::log1p((x - z + term) / z), (x + q.hi * term) / (x + term)};
      },
      start);
  if (!(u > 0)) return {0, q.hi < 1 ? 0.0 : 1.0};
  return {u, 1 / (1 + q.hi * (power_term(rho, u, q) / u))};
}

/// u > 0 with u - rho u^-m = z, and du/dz.
ScalarProx root_of_difference(double z, double rho, Exponent m) {
  const Exponent minus{-m.hi, -m.lo};
  const double log_rho = std::log(rho), middle = log_rho / (m.hi + 1);  // log u at z = 0
  double u = 0;
  if (z > 0) {  // in s = u - z, s (z + s)^m = rho
    const double start = std::exp(std::min(log_rho - m.hi * std::log(z), middle));
    u = z + fall_to_root(
                [&](double s) {
                  return std::pair{std::log(s / power_term(rho, z + s, minus)), 1 + m.hi * (s / (z + s))};
                },
                start);
  } else {
    const double start = std::exp(z < 0 ? std::min((log_rho - std::log(-z)) / m.hi, middle) : middle);
    u = fall_to_root(
        [&](double x) {
          return std::pair{std::log((x - z) / power_term(rho, x, minus)), x / (x - z) + m.hi};
        },
        start);
  }
  if (!(u > 0)) return {0, 0};
  return {u, 1 / (1 + m.hi * (power_term(rho, u, minus) / u))};
}

/// An odd prox from its positive half; at 0 its slope is that of `at_zero`.
template <class Positive>
ScalarProx odd(double z, double at_zero, Positive prox) {
  if (!(std::abs(z) > 0)) return {z, at_zero};
  const ScalarProx half = prox(std::abs(z));
  return {std::copysign(half.x, z), half.slope};
}

void require_power(double p) {
  if (!(p >= 1 && std::isfinite(p)))
    throw InvalidInput("power: the exponent is " + std::to_string(p) + "; give a finite one of at least 1");
}

void require_positive(double q) {
  if (!(q > 0 && std::isfinite(q)))
    throw InvalidInput("inverse_power: the exponent is " + std::to_string(q) + "; give a positive one");
}

}  // namespace

ScalarProx prox_power(double z, double d, double p) {
  require_power(p);
  const double rho = p / d;
  if (!(p > 1)) {
    const bool outside = std::abs(z) > rho;
    return {outside ? z - std::copysign(rho, z) : 0.0, outside ? 1.0 : 0.0};
  }
  if (!(p < 2 || p > 2)) return {z / (1 + rho), 1 / (1 + rho)};
  return odd(z, p < 2 ? 0.0 : 1.0, [&](double c) { return root_of_sum(c, rho, two_sum(p, -1)); });
}

ScalarProx prox_power_conjugate(double z, double d, double p) {
  require_power(p);
  if (!(p > 1)) return {std::clamp(z, -1.0, 1.0), std::abs(z) < 1 ? 1.0 : 0.0};
  if (!(p < 2 || p > 2)) return {z / (1 + 0.5 / d), 1 / (1 + 0.5 / d)};
  const Exponent r = reciprocal(two_sum(p, -1));  // the derivative of the conjugate is (u/p)^r
  const double rho = power_term(1 / d, p, {-r.hi, -r.lo});
  return odd(z, p < 2 ? 1.0 : 0.0, [&](double c) { return root_of_sum(c, rho, r); });
}

ScalarProx prox_inverse_power(double z, double d, double q) {
  require_positive(q);
  return root_of_difference(z, q / d, two_sum(q, 1));
}

ScalarProx prox_inverse_power_conjugate(double z, double d, double q) {
  require_positive(q);
  const Exponent r = reciprocal(two_sum(q, 1));  // the derivative of the conjugate is (-u/q)^-r
  const ScalarProx mirrored = root_of_difference(-z, power_term(1 / d, q, r), r);
  return {-mirrored.x, mirrored.slope};
}

}  // namespace convex::prox_formulas
