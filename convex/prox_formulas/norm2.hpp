#pragma once

#include <vector>

#include "convex/vector.hpp"

/// The Euclidean norm and its ball, in the plain metric. z is finite; InvalidInput when a radius or weight is
/// negative or not a number, or sizes do not fit. No square overflows or underflows.
namespace convex::prox_formulas {

/// |z|₂, of any scale.
double length(const Eigen::Ref<const Vector>& z);
/// z wanted/norm, for 0 <= wanted and the positive norm of z.
Vector rescaled(const Eigen::Ref<const Vector>& z, double norm, double wanted);

/// Nearest point of {|x - center| <= radius}.
Vector proj_ball2(const Vector& z, double radius = 1);
Vector proj_ball2(const Vector& z, double radius, const Vector& center);
/// (radius/|v|)(I - v vᵀ/|v|²), v = z - center, outside; I inside.
Matrix proj_ball2_jacobian(const Vector& z, double radius, const Vector& center);

/// Prox of weight |u|₂: z shortened by `weight`, or 0.
Vector prox_norm2(const Vector& z, double weight = 1);
/// (1 - weight/|z|) I + (weight/|z|) z zᵀ/|z|² outside the ball of radius `weight`; 0 inside.
Matrix prox_norm2_jacobian(const Vector& z, double weight);

/// Prox of Σ_k weight_k |u over group k|₂ (Yuan and Lin 2006), the groups being runs of sizes that sum to n.
Vector prox_group_norm(const Vector& z, const std::vector<Index>& sizes, const Vector& weight);
Matrix prox_group_norm_jacobian(const Vector& z, const std::vector<Index>& sizes, const Vector& weight);

}  // namespace convex::prox_formulas
