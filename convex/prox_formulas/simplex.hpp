#pragma once

#include "convex/vector.hpp"

/// The simplex, the l1 ball, and their support functions max and norm_inf. In a diagonal metric d (entries
/// positive and finite) distances are sqrt(Σ d_i (u_i - z_i)²). z is finite. InvalidInput when sizes do not
/// fit, a total, radius or weight is negative or not finite, or a simplex of positive total has no entries.
///
/// In the plain metric the level is found by filtering with a rising lower bound (Michelot 1986; Condat 2016,
/// taken block by block so that the filter has no branches), in O(n) observed. Differences to the largest
/// entry are exact where they matter, so the error is a few roundings of `total` however far z lies.
namespace convex::prox_formulas {

/// Nearest point of {x >= 0, Σx = total}.
Vector proj_simplex(const Vector& z, double total = 1);
Vector proj_simplex(const Vector& z, double total, const Vector& d);

/// Nearest point of {Σ|x| <= radius}.
Vector proj_ball1(const Vector& z, double radius = 1);
Vector proj_ball1(const Vector& z, double radius, const Vector& d);

/// Prox of weight max_i u_i: min(z, level), with Σ d_i max(0, z_i - level) = weight.
Vector prox_max(const Vector& z, double weight = 1);
Vector prox_max(const Vector& z, double weight, const Vector& d);

/// Prox of weight max_i |u_i|.
Vector prox_norm_inf(const Vector& z, double weight = 1);
Vector prox_norm_inf(const Vector& z, double weight, const Vector& d);

/// An element of the generalised Jacobian at z, in metric d (symmetric when d is constant): n×n.
Matrix proj_simplex_jacobian(const Vector& z, double total, const Vector& d);
Matrix proj_ball1_jacobian(const Vector& z, double radius, const Vector& d);
Matrix prox_max_jacobian(const Vector& z, double weight, const Vector& d);
Matrix prox_norm_inf_jacobian(const Vector& z, double weight, const Vector& d);

}  // namespace convex::prox_formulas
