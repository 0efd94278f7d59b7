#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline multiplier_sets {

/// By row, the largest forces, ||·||_(A⁻¹), of what A and U couple to it: however hard others are pressed, a
/// light contact that they do not move is not weighed against them.
struct CoupledForces {
  Vector pushes;  ///< |lambda_b| ||u_b||_(A⁻¹) of rows: m
  Vector others;  ///< z and A q: m
};

/// `rows`: those with multipliers; length: ||u_a||_(A⁻¹) of these.
CoupledForces coupled_forces(const NearestPointProblem&, const Solution&, const Vector& lambda,
                             const std::vector<Index>& rows, const Vector& length);

}  // namespace convex::inline multiplier_sets
