#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline isotonic {

/// A chain: A diagonal, and one-sided rows c (q_j - q_i) >= s, c > 0, that string the coordinates up, each
/// following at most one other; the first of a string may have a floor, c q_i >= s. By q_i = y_i + (sum of
/// the s/c below) it is isotonic regression with weights a_ii, solved by pooling adjacent violators (Ayer,
/// Brunk, Ewing, Reid and Silverman 1955) in O(n), the answer from sums in twice the working precision; a
/// floor is a lower bound of the monotone y, which cuts the unbounded answer off. None when the problem is no
/// chain. The data are checked.
std::optional<Solution> solve_chain(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline isotonic
