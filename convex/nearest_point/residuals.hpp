#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// Judges q and lambda, as they stand, by the residuals of `Residuals`; whoever found them is judged by this
/// one piece of code. `length` has ||u_a||_(A⁻¹) where it is known, else 0. Sums are in twice the working
/// precision.
Residuals residuals(const NearestPointProblem&, const Vector& q, const Vector& lambda, Vector length);

/// ||u_a||_(A⁻¹) for the rows given, 0 for the others: m.
Vector dual_lengths(const NearestPointProblem&, const std::vector<Index>& rows);

}  // namespace convex
