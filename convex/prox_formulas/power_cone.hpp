#pragma once

#include "convex/vector.hpp"

/// The power cone {(x, y, z) : x^alpha y^(1 - alpha) >= |z|, x >= 0, y >= 0}, 0 < alpha < 1 (InvalidInput
/// otherwise), in the plain metric, after Hien (2015): off the cone and its polar the nearest point to (x, y,
/// z) has |z'| = r in (0, |z|), x' = ½(x + sqrt(x² + 4 alpha r (|z| - r))) and y' likewise with 1 - alpha, on
/// the boundary: one equation, solved in log(r/(|z| - r)), so that r and |z| - r keep all digits.
namespace convex::prox_formulas {

/// Nearest point of the cone. A point of the cone is returned as it is. z finite.
Eigen::Vector3d proj_power_cone(const Eigen::Vector3d& z, double alpha);

/// Nearest point of the polar {(-x/alpha)^alpha (-y/(1 - alpha))^(1 - alpha) >= |z|, x <= 0, y <= 0}.
Eigen::Vector3d proj_power_polar(const Eigen::Vector3d& z, double alpha);

/// An element of the generalised Jacobian at z, symmetric: off the faces p pᵀ + theta c cᵀ with p the unit
/// ray that z lands on and c the unit normal of p and z - x.
Eigen::Matrix3d proj_power_cone_jacobian(const Eigen::Vector3d& z, double alpha);

}  // namespace convex::prox_formulas
