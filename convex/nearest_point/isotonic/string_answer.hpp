#pragma once

#include "convex/double_double.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// The solution that q, known in twice the working precision but for `missing` (in the norm of A), and its
/// multipliers make: slacks, residuals, bound and status. `basis` is left empty.
Solution string_answer(const NearestPointProblem&, const Accuracy&, const DoubleDoubleVector& q,
                       Vector lambda, double missing);

}  // namespace convex
