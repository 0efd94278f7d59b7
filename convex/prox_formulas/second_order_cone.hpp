#pragma once

#include "convex/vector.hpp"

/// Second-order cones in the plain metric. z = (v, t), t last, n >= 1 (InvalidInput otherwise); rotated:
/// z = (v, a, b), n >= 2. A point that the cone contains is returned as it is.
namespace convex::prox_formulas {

/// Nearest point of {|v|₂ <= t}.
Vector proj_second_order_cone(const Vector& z);
/// Nearest point of its polar {|v|₂ <= -t}.
Vector proj_second_order_polar(const Vector& z);
/// Between the two cones ½[(1 + r)I - r e eᵀ, e; eᵀ, 1], e = v/|v|, r = t/|v|.
Matrix proj_second_order_cone_jacobian(const Vector& z);

/// Nearest point of {|v|₂² <= 2ab, a >= 0, b >= 0}.
Vector proj_rotated_cone(const Vector& z);
/// Nearest point of its polar {|v|₂² <= 2ab, a <= 0, b <= 0}.
Vector proj_rotated_polar(const Vector& z);
Matrix proj_rotated_cone_jacobian(const Vector& z);

}  // namespace convex::prox_formulas
