#pragma once

#include <numbers>

#include "convex/prox_formulas/scalar_prox.hpp"

namespace convex::prox_formulas {

/// Prox of u log(u/r) - u + r, u >= 0 (Kullback and Leibler 1951), r >= 0: x = W(d r e^(dz)) / d. For r = 0
/// the function is the indicator of {0}. To a few units in the last place of x, however small.
ScalarProx prox_kullback_leibler(double z, double d, double r);

/// Prox of u log u, u >= 0, which is the former with r = 1/e, up to a constant.
inline ScalarProx prox_entropy(double z, double d) {
  return prox_kullback_leibler(z, d, 1 / std::numbers::e);
}

/// Prox of u log u - u, u >= 0, the conjugate of e^x.
inline ScalarProx prox_exponential_conjugate(double z, double d) { return prox_kullback_leibler(z, d, 1); }

/// Prox of weight e^u, weight >= 0: the root of x + (weight/d) e^x = z.
ScalarProx prox_exponential(double z, double d, double weight = 1);

/// Prox of e^(u - 1), the conjugate of x log x.
inline ScalarProx prox_entropy_conjugate(double z, double d) {
  return prox_exponential(z, d, 1 / std::numbers::e);
}

/// Prox of r (e^u - 1), the conjugate of x log(x/r) - x + r.
inline ScalarProx prox_kullback_leibler_conjugate(double z, double d, double r) {
  return prox_exponential(z, d, r);
}

}  // namespace convex::prox_formulas
