#pragma once

#include "convex/vector.hpp"

/// The simplex with bounded entries and its support function, the sum of the k largest entries. In a diagonal
/// metric d distances are sqrt(Σ d_i (u_i - z_i)²). z is finite. InvalidInput when sizes do not fit, the set
/// is empty, or k is not a number of entries.
namespace convex::prox_formulas {

/// Nearest point of {0 <= x <= cap, Σx = total}, 0 <= total <= n cap.
Vector proj_capped_simplex(const Vector& z, double cap, double total);
Vector proj_capped_simplex(const Vector& z, double cap, double total, const Vector& d);

/// Prox of weight times the sum of the k largest entries, 0 <= k <= n (k need not be whole):
/// x_i = z_i below a level, the level up to level + weight/d_i, and z_i - weight/d_i above.
Vector prox_sum_largest(const Vector& z, double k, double weight = 1);
Vector prox_sum_largest(const Vector& z, double k, double weight, const Vector& d);

/// An element of the generalised Jacobian at z: n×n.
Matrix proj_capped_simplex_jacobian(const Vector& z, double cap, double total, const Vector& d);

}  // namespace convex::prox_formulas
