#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// Takes back `solved` where one-sided rows that the answer violates by rounding exclude each other, as the
/// numbers stand, by more than rounding s to doubles can explain (`is_empty_wedge`): the bound becomes
/// infinite. For data that are meant as they stand; callers whose s has been computed accept more. solution:
/// of a method with dense factors; others, and those that violate no row, are left alone at no cost.
void doubt_empty_wedges(const NearestPointProblem&, Solution& solution);

}  // namespace convex
