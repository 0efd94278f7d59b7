#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"

namespace mechanics {

using convex::Vector;

/// q_0 with A q_0 = x_0, where C = {q'' : u_a·q'' >= s_a} is a cone with the vertex x_0 though its equations
/// contradict each other, some being redundant. The rows are >= 0 in the directions of such a cone, so that
/// x_0 is the lowest point of C for their sum, and the nearest one of C to points far enough below. It is the
/// vertex if each row that it does not hold, p, is implied by those that it does: u_p = Σ w_a u_a with w_a >=
/// 0 on one-sided rows (Farkas 1902), to rounding. None otherwise: then C is no cone, or one too flat to be
/// told from a half-space in doubles. C must not be empty. limit: of fractions, as in `convex::Accuracy`.
std::optional<Vector> vertex_acceleration(const convex::NearestPointProblem&, double limit = 1);

}  // namespace mechanics
