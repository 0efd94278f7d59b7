#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// The alternating direction method of multipliers (Gabay and Mercier 1976) in the form of Stellato and
/// others (2020): one regularised system with the weight 1/rho on all rows, a projection of the slacks,
/// over-relaxation, and a rho that balances the two residuals. Dense or sparse.
Solution admm(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
