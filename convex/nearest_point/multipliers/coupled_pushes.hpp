#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline multiplier_sets {

/// By row, the largest |lambda_b| ||u_b||_(A⁻¹) of what A and U couple to it: however large those of others
/// are, a row that they do not move is not weighed against them.
struct CoupledPushes {
  Vector pushes;  ///< |lambda_b| ||u_b||_(A⁻¹) of rows: m
  Vector others;  ///< z and A q: m
};

/// `rows`: those with multipliers; length: ||u_a||_(A⁻¹) of these.
CoupledPushes coupled_pushes(const NearestPointProblem&, const Solution&, const Vector& lambda,
                             const std::vector<Index>& rows, const Vector& length);

}  // namespace convex::inline multiplier_sets
