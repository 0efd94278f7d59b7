#pragma once

#include "convex/nearest_point/problem.hpp"

namespace convex::inline optimality {

/// Whether w proves that no q satisfies the rows (Farkas 1902): w_a >= 0 on one-sided rows, wᵀU = 0 to the
/// rounding of its terms, w·s > 0 beyond the rounding of s, and what the rest of wᵀU and the radii, if there
/// are any, could hide for any q with ||q||_A <= reach. All sums in twice the working precision. w: m.
bool proves_infeasibility(const NearestPointProblem&, const Vector& w, double reach);

}  // namespace convex::inline optimality
