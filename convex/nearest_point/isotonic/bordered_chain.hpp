#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline isotonic {

/// Strings of coordinates (`strings.hpp`) and a few rows that fit into none, its border: links of other
/// factors, rings, ceilings, two-sided rows, anything. For given multipliers mu of the border the strings are
/// solved by pooling; mu maximises the concave dual function, whose gradient is s - Uq on the border and
/// whose curvature is that of the border on motions that leave the pools together: semismooth Newton steps
/// (Qi and Sun 1993; as for isotonic regression with one budget) with an exact search along each, then with q
/// in twice the working precision. None when the structure is not there or the steps do not settle. The data
/// are checked.
std::optional<Solution> solve_bordered_chain(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline isotonic
