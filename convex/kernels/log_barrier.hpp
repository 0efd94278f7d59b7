#pragma once

#include "convex/kernels/scalar_prox.hpp"

namespace convex::kernels {

/// Prox of -log u, u > 0: the positive root of d x (x - z) = 1.
ScalarProx prox_log_barrier(double z, double d);

/// Prox of its conjugate -1 - log(-u), u < 0: the negative root of d x (x - z) = 1.
ScalarProx prox_log_barrier_conjugate(double z, double d);

}  // namespace convex::kernels
