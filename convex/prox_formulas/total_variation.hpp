#pragma once

#include "convex/prox_formulas/blocks.hpp"

namespace convex::prox_formulas {

/// Prox of weight Σ |u_(i+1) - u_i|: the slopes of the taut string through the tube of half width `weight`
/// about the running sums of z (Mammen and van de Geer 1997; Davies and Kovac 2001), drawn as the shortest
/// path in a funnel: O(n) in the worst case. Running sums are kept in twice the working precision, so values
/// are right to a few roundings. d: weights of ½Σ d_i (u_i - z_i)², positive. InvalidInput when sizes do not
/// fit, a weight of d is not positive or `weight` is negative or not finite.
Blocks prox_total_variation(const Vector& z, double weight);
Blocks prox_total_variation(const Vector& z, double weight, const Vector& d);

}  // namespace convex::prox_formulas
