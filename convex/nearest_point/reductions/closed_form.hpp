#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline reductions {

/// The answer to a problem without rows, q = A⁻¹z, or with one, lambda = (s - u·A⁻¹z)⁺ / u·A⁻¹u, refined
/// against the original equations in twice the working precision as active_set does. The residuals are left
/// to the caller. None when the formula does not carry: a row without length, or a refinement that does not
/// converge. The data are checked.
std::optional<Solution> closed_form(const NearestPointProblem&, const Accuracy&);

}  // namespace convex::inline reductions
