#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// Every independent set of rows is held in turn, in the order of a tree over the rows, until one meets all
/// conditions to rounding; the one that violates them least is handed to `crossover`. The definition turned
/// into a method, for up to 20 one-sided rows.
Solution enumerate(const NearestPointProblem&, const Accuracy& = {});

/// The number of one-sided rows up to which `enumerate` applies.
inline constexpr Index most_enumerated_rows = 20;

}  // namespace convex::inline algorithms
