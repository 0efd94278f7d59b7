#pragma once

#include <optional>

#include "convex/nearest_point/entry_radii.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline proof {

/// A proved bound on ||q - q*||_A for the q of the solution as it stands, q* the exact solution of the
/// problem's doubles; it proves on the way that A is positive definite, that the rows of the solution's basis
/// are independent with strictly positive multipliers, and that every slack of another row is strictly
/// positive, or how little the rows that depend on them matter. None when rounding leaves something else
/// open. In doubles rounded to nearest, with a bound on every rounding (docs/proof.md, section 3).
std::optional<double> enclosed_error(const NearestPointProblem&, const Solution&);

/// The same for every problem within the radii of this one, q* its solution, in its metric: that each has one
/// is proved.
std::optional<double> enclosed_error(const NearestPointProblem&, const EntryRadii&, const Solution&);

}  // namespace convex::inline proof
