#pragma once

#include "convex/prox_formulas/scalar_prox.hpp"

namespace convex::prox_formulas {

/// Prox of |u|^p, 1 <= p < inf.
ScalarProx prox_power(double z, double d, double p);

/// Prox of its conjugate (p - 1) (|u|/p)^(p/(p - 1)); for p = 1 the indicator of [-1, 1].
ScalarProx prox_power_conjugate(double z, double d, double p);

/// Prox of u^-q on u > 0, q > 0.
ScalarProx prox_inverse_power(double z, double d, double q);

/// Prox of its conjugate -(1 + q) (-u/q)^(q/(q + 1)) on u <= 0.
ScalarProx prox_inverse_power_conjugate(double z, double d, double q);

}  // namespace convex::prox_formulas
