#pragma once

#include "convex/prox_formulas/scalar_prox.hpp"

namespace convex::prox_formulas {

/// Prox of log(1 + e^u): the root of x + 1/(d (1 + e^-x)) = z. By symmetry x(z) = -x(1/d - z), so only x <= 0
/// is solved for, where the equation is convex and bracketed by two exponential ones.
ScalarProx prox_logistic(double z, double d);

/// Prox of its conjugate, u log u + (1 - u) log(1 - u) on [0, 1]: log(x/(1 - x)) + d(x - z) = 0. By symmetry
/// x(z) = 1 - x(1 - z), so only x <= ½ is solved for, downwards from the prox of u log u - u; to a few units
/// in the last place of x, however small.
ScalarProx prox_binary_entropy(double z, double d);

}  // namespace convex::prox_formulas
