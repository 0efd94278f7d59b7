#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// The answer to a problem without rows, q = A⁻¹z, or with one, lambda = (s - u·A⁻¹z)⁺ / u·A⁻¹u: a working
/// set that holds the row or does not, refined and certified as active_set does. None when the formula does
/// not carry: a row without length, a refinement that does not converge, or a row that doubles do not decide.
/// The data are checked.
std::optional<Solution> closed_form(const NearestPointProblem&, const Accuracy&);

}  // namespace convex::inline algorithms
