#pragma once

#include "convex/vector.hpp"

/// The Euclidean norm and its ball, in the plain metric. z is finite; InvalidInput when a radius or weight is
/// negative or not a number. No square overflows or underflows.
namespace convex::prox_formulas {

/// |z|₂, of any scale.
double length(const Eigen::Ref<const Vector>& z);
/// z wanted/norm, for 0 <= wanted and the positive norm of z.
Vector rescaled(const Eigen::Ref<const Vector>& z, double norm, double wanted);

/// Nearest point of {|x| <= radius}.
Vector proj_ball2(const Vector& z, double radius = 1);

/// Prox of weight |u|₂: z shortened by `weight`, or 0.
Vector prox_norm2(const Vector& z, double weight = 1);

}  // namespace convex::prox_formulas
