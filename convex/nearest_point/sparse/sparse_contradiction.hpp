#pragma once

#include "convex/nearest_point/solution.hpp"
#include "convex/nearest_point/sparse/row_system.hpp"

namespace convex::inline sparse {

/// Multipliers that grow without bound, scaled, point along a witness that the rows contradict each other:
/// its part in the null space of Uᵀ, on the rows that grow. `infeasible` when that is proved, else `gave_up`.
Solution sparse_contradiction(const NearestPointProblem&, const BalancedProblem&, RowSystem&,
                              const Vector& lambda);

}  // namespace convex::inline sparse
