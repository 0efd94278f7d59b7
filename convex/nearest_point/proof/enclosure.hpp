#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// A proved bound on ||q - q*||_A for the q of the solution as it stands, q* the exact solution of the
/// problem's doubles; it proves on the way that A is positive definite, that the rows of the solution's basis
/// are independent, and that they are the active ones: every multiplier is strictly positive, every slack of
/// another row strictly positive. None when a sign is not strict or rounding leaves something open. In
/// doubles rounded to nearest, with a bound on every rounding (docs/proof.md, section 3).
std::optional<double> enclosed_error(const NearestPointProblem&, const Solution&);

}  // namespace convex
