#pragma once

#include "convex/vector.hpp"

/// The norm |x|_p = (Σ |x_i|^p)^(1/p), 1 <= p <= inf, and the balls {|x|_p <= radius}, of vectors with
/// entries
/// >= 0, as singular values are. Each formula finds its own level.
namespace convex::prox_formulas {

/// Prox of weight |x|_p: with y = x/s, s = |x|_p, it is s y_i + weight y_i^(p-1) = z_i where |y|_p = 1.
Vector prox_norm_p(const Vector& z, double weight, double p);

/// Nearest point of {|x|_p <= radius}: with y = x/radius, radius y_i + m y_i^(p-1) = z_i where |y|_p = 1.
Vector proj_ball_p(const Vector& z, double radius, double p);

/// An element of the generalised Jacobian of prox_norm_p: n×n.
Matrix prox_norm_p_jacobian(const Vector& z, double weight, double p);

/// |x|_p.
double norm_p(const Vector& x, double p);

/// q with 1/p + 1/q = 1.
double dual_exponent(double p);

}  // namespace convex::prox_formulas
