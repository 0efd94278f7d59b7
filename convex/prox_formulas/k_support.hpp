#pragma once

#include "convex/vector.hpp"

/// The k-support norm (Argyriou, Foygel and Srebro 2012) and the ball of its dual, the root of the sum of the
/// k largest squares. 1 <= k <= n. Each formula finds its own pair of levels.
namespace convex::prox_formulas {

/// The norm: min Σ x_i²/theta_i over 0 <= theta <= 1, Σ theta = k, is its square.
double k_support_norm(const Vector& x, Index k);
/// The root of the sum of the k largest squares.
double norm_of_largest(const Vector& x, Index k);

/// Prox of weight times the norm: x_i = z_i theta_i/(theta_i + lambda), theta_i = clamp(alpha |z_i| - lambda,
/// 0, 1), with Σ theta = k and lambda |x| = weight.
Vector prox_k_support(const Vector& z, double weight, Index k);
/// Its generalised Jacobian: n×n.
Matrix prox_k_support_jacobian(const Vector& z, double weight, Index k);

/// Nearest point of {norm_of_largest <= radius}: v_i = z_i/(1 + mu c_i), c_i = clamp((|z_i|/t - 1)/mu, 0, 1),
/// with Σ c = k and the radius reached.
Vector proj_largest_ball(const Vector& z, double radius, Index k);

/// A maximiser of v·x over {norm_of_largest <= 1}.
Vector k_support_slope(const Vector& x, Index k);

}  // namespace convex::prox_formulas
