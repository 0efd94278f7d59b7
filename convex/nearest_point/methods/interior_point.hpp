#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// The predictor-corrector interior-point method of Mehrotra (1992) for quadratic programs, with regularised
/// equations (Vanderbei 1995; Altman and Gondzio 1999), dense or sparse as `RegularisedKkt` is. Two-sided
/// rows enter with the regularisation alone. Without a solution the multipliers diverge along a proof of
/// that, which `crossover` looks for.
Solution interior_point(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
