#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// The proximal-point method on the multipliers, which is that of augmented Lagrangians (Rockafellar 1976),
/// each of them minimised by a damped Newton method on its pieces (Li, Sun and Toh 2018); dense or sparse. No
/// assumption on the rows: on dependent ones the multipliers converge to some that are right.
Solution proximal_point(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
