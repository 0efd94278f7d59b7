#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// Nesterov's accelerated projected gradient on the dual (1983), restarted whenever a step points against the
/// gradient (O'Donoghue and Candès 2015). Dense or sparse: a step costs a product with U, one with Uᵀ and a
/// solve with A.
Solution accelerated_gradient(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
