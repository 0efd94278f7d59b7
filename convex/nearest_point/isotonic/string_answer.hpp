#pragma once

#include <functional>
#include <optional>

#include "convex/double_double.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline isotonic {

/// The solution that q, known in twice the working precision but for `missing` (in the norm of A), and its
/// multipliers make: slacks, residuals, bound and status. A slack that `missing` and the rounding of sums
/// could hide has the sign that `sign_of` finds for its row; it is `undecided` where that finds none. `basis`
/// is left empty.
Solution string_answer(const NearestPointProblem&, const Accuracy&, const DoubleDoubleVector& q,
                       Vector lambda, double missing,
                       const std::function<std::optional<int>(Index)>& sign_of);

}  // namespace convex::inline isotonic
