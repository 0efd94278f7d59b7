#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"
#include "mechanics/warning.hpp"
#include "mechanics/written_mechanism.hpp"

namespace mechanics {

/// Of one-sided contacts whose gradient is 0 at the state, second derivatives tell nothing: f = y³ at y = 0
/// asks for y >= 0 all the same. Warns of those that the answer q2 would violate: the first Taylor
/// coefficient of f along q + q'τ + ½ q''τ² that rounding does not hide is negative. None when there are
/// none. Row k of the problem is that of contacts[k].
std::optional<Warning> violated_at_higher_order(const WrittenMechanism&, const std::vector<Index>& contacts,
                                                const convex::NearestPointProblem&, const Vector& q2);

}  // namespace mechanics
