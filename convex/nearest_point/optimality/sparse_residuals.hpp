#pragma once

#include "convex/nearest_point/optimality/residuals.hpp"

namespace convex::inline optimality {

/// `residuals` for a diagonal A and sparse rows: the same numbers from one pass over the rows, without lists.
/// Lengths are computed, whether known or not.
Residuals sparse_residuals(const NearestPointProblem&, const Solution&);

/// The same where ||Aq - z - Uᵀlambda||_(A⁻¹) is known; only the rows first … end - 1 may leave anything.
Residuals sparse_residuals(const NearestPointProblem&, const Solution&, double unbalanced, Index first,
                           Index end);

}  // namespace convex::inline optimality
