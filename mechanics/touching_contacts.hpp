#pragma once

#include "convex/nearest_point/multipliers/multipliers.hpp"

namespace mechanics {

using convex::Index;

/// The one-sided rows with u_a·q'' = s_a that push for no choice of the multipliers, lambda_a u_a = 0 within
/// the tolerance times the largest force: to second order they neither press nor open. None where multipliers
/// are neither unique nor given by ranges.
std::vector<Index> touching_contacts(const convex::NearestPointProblem&, const convex::Solution&,
                                     const convex::Multipliers&, double tolerance);

}  // namespace mechanics
