#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"

namespace mechanics {

using convex::Vector;

/// q_0 with A q_0 = x_0, where C = {q'' : u_a·q'' >= s_a} is a cone with the vertex x_0 though its equations
/// contradict each other: a row that the others imply takes no part. A row is implied when (u_p, s_p) = Σ w_a
/// (u_a, s_a) - (0, t), w_a >= 0 on one-sided rows and t >= 0 (Farkas), to rounding. Such rows are dropped
/// one after the other, and the equations of the others solved. None when these contradict each other too:
/// then C is no cone. C must not be empty.
std::optional<Vector> vertex_acceleration(const convex::NearestPointProblem&);

}  // namespace mechanics
