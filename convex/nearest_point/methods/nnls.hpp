#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// Lawson and Hanson's nonnegative least squares (1974). When Uq = s has a solution q_0, R is the nearest
/// point to A q_0 - z in the cone of the u_a (Moreau 1966, section 5); otherwise the problem is brought to
/// least distance and homogenised (Lawson and Hanson, chapter 23, section 4), where a zero residual is a
/// proof that there is no solution.
Solution nnls(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
