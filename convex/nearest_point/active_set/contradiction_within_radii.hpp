#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"

namespace convex::inline dual_active_set {

/// Weights that prove that no q satisfies the rows, whose numbers are known within radii, from weights w that
/// seem to. Large weights on a row and its near-multiple may hide in their roundings that the other rows do
/// not cancel. So the dual active set decides it, on the rows with weights alone: by rows of which one
/// depends on independent others, at a point that these allow. None where it finds a point. w: m; the result
/// too.
std::optional<Vector> contradiction_within_radii(const NearestPointProblem&, const Vector& w);

}  // namespace convex::inline dual_active_set
