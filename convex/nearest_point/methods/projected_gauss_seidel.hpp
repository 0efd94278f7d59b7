#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// Projected Gauss-Seidel on the dual, with over-relaxation (Cryer 1971; in mechanics Jean and Moreau 1992):
/// row by row the multiplier takes the value that makes the row hold, or 0. Slow where heavy bodies stand on
/// light ones and where rows are near parallel. Dense.
Solution projected_gauss_seidel(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
