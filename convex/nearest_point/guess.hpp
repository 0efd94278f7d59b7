#pragma once

#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace convex {

/// Throws InvalidInput when a guess of active rows names a row that is not there. Their order, and rows named
/// twice, do not matter.
void validate_guess(const NearestPointProblem&, const std::vector<Index>& guess);

}  // namespace convex
