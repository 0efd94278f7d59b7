#pragma once

#include "convex/vector.hpp"

/// The exponential cone, the closure of {(x, y, t) : y > 0, y e^(x/y) <= t}, in the plain metric, after
/// Friberg (2023): off its faces, z = A (rho, 1, e^rho) + B (1, 1 - rho, -e^-rho) with A, B > 0, a ray of the
/// cone and a ray of the polar that are orthogonal for every rho. Two entries of z give A and B, the third
/// one equation in rho with one root. The root is sought in its distance to the nearer end of its interval,
/// where A or B vanishes, so that both keep all digits; the rounding of rho itself is carried along.
namespace convex::prox_formulas {

/// Nearest point of the cone. A point of the cone is returned as it is. z finite.
Eigen::Vector3d proj_exponential_cone(const Eigen::Vector3d& z);

/// Nearest point of the polar, the closure of {(x, y, t) : x > 0, x e^(y/x - 1) <= -t}.
Eigen::Vector3d proj_exponential_polar(const Eigen::Vector3d& z);

/// An element of the generalised Jacobian at z, symmetric: off the faces p pᵀ + theta c cᵀ with p the unit
/// ray that z lands on and c the unit normal of p and z - x.
Eigen::Matrix3d proj_exponential_cone_jacobian(const Eigen::Vector3d& z);

}  // namespace convex::prox_formulas
