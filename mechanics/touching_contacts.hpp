#pragma once

#include "convex/nearest_point/multipliers/multipliers.hpp"

namespace mechanics {

using convex::Index;

/// The one-sided rows with u_a·q'' = s_a that push for no choice of the multipliers: to second order they
/// neither press nor open. lambda_a u_a is 0 within rounding of the largest force; or it is within the
/// tolerance of that, and without the row the acceleration is the same as far as its bounds tell. None where
/// multipliers are neither unique nor given by ranges.
std::vector<Index> touching_contacts(const convex::NearestPointProblem&, const convex::Solution&,
                                     const convex::Multipliers&, double tolerance);

}  // namespace mechanics
