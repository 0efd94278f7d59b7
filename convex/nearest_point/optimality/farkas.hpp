#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"

namespace convex::inline optimality {

/// Whether w proves that no q satisfies the rows (Farkas 1902): w_a >= 0 on one-sided rows, wᵀU = 0 to the
/// rounding of its terms, w·s > 0 beyond the rounding of s, and what the rest of wᵀU and the radii, if there
/// are any, could hide for any q with ||q||_A <= reach. All sums in twice the working precision. w: m, else
/// InvalidInput.
bool proves_infeasibility(const NearestPointProblem&, const Vector& w, double reach);

/// Weights that prove infeasibility to rounding, from weights w that do so roughly: w >= 0 on one-sided rows
/// with wᵀU near 0 and w·s > 0. While rows of its support depend on each other, w moves along the dependence
/// that does not lower w·s until a weight is 0 or, where none falls, that dependence itself is the proof
/// (Carathéodory's argument on the cone of such weights). The result has passed `proves_infeasibility` for
/// motions up to `reach`.
std::optional<Vector> farkas_circuit(const NearestPointProblem&, const Vector& w, double reach);

}  // namespace convex::inline optimality
