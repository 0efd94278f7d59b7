#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// The rule that Delassus gave (1917) and Moreau rejects (1966): hold all rows, drop those with negative
/// multipliers at once, hold the rest and take that for the answer. Wrong in general; for comparison.
/// `crossover` does not mend it: the status is `solved` only where the rule happens to be right.
Solution drop_negative(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
