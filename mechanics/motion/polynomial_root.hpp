#pragma once

#include <optional>
#include <span>

namespace mechanics::inline motions {

/// More than any series of a motion has.
inline constexpr std::size_t most_coefficients = 64;

/// Where a function that starts positive comes to 0.
struct FirstZero {
  double at = 0;
  bool is_touch = false;  ///< it comes to 0 within rounding and goes up again: a double root
};

/// The first zero in (0, end] of p(τ) = Σ c_k τ^k, p > 0 just after 0, found by the signs of Bernstein
/// coefficients (Descartes' rule on intervals; Lane and Riesenfeld 1981), so that neither two zeros close
/// together nor a double one are missed. A minimum within `rounding` (absolute, in units of p) counts as 0.
std::optional<FirstZero> first_zero(std::span<const double> c, double end, double rounding);

/// The least of p over [0, end], as far as it is below `known` by more than rounding; else `known`.
double least_value(std::span<const double> c, double end, double known);

}  // namespace mechanics::inline motions
