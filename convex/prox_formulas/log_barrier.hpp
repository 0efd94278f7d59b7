#pragma once

#include "convex/prox_formulas/scalar_prox.hpp"

namespace convex::prox_formulas {

/// Prox of -log u, u > 0: the positive root of d x (x - z) = 1.
ScalarProx prox_log_barrier(double z, double d);

/// Prox of its conjugate -1 - log(-u), u < 0: the negative root of d x (x - z) = 1.
ScalarProx prox_log_barrier_conjugate(double z, double d);

}  // namespace convex::prox_formulas
