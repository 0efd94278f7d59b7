#pragma once

#include "convex/prox_formulas/blocks.hpp"

namespace convex::prox_formulas {

/// Isotonic regression: the nearest point with x_1 <= x_2 <= ... <= x_n, the projection on the monotone cone,
/// by pooling adjacent violators (Ayer, Brunk, Ewing, Reid and Silverman 1955) in O(n). Means are of sums in
/// twice the working precision. d: weights of Σ d_i (x_i - z_i)², positive; InvalidInput otherwise.
Blocks proj_monotone(const Vector& z);
Blocks proj_monotone(const Vector& z, const Vector& d);

/// The nearest point with x_1 >= x_2 >= ... >= x_n.
Blocks proj_decreasing(const Vector& z);
Blocks proj_decreasing(const Vector& z, const Vector& d);

/// Moves u into the normal cone of {x_1 <= ... <= x_n} at x: its running sums are >= 0, and 0 where x rises
/// and at the end.
void keep_normal_to_monotone(Vector& x, Vector& u);

/// Prox of Σ w_i |u|_(i), |u|_(1) >= |u|_(2) >= ..., with w_1 >= w_2 >= ... >= w_n >= 0 (the sorted l1 norm;
/// Bogdan, van den Berg, Sabatti, Su and Candès 2015): O(n log n). InvalidInput when w is not so ordered.
Vector prox_sorted_norm1(const Vector& z, const Vector& w);

}  // namespace convex::prox_formulas
