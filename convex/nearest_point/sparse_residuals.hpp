#pragma once

#include "convex/nearest_point/residuals.hpp"

namespace convex {

/// `residuals` for a diagonal A and sparse rows: the same numbers from one pass over the rows, without lists.
/// Lengths are computed, whether known or not.
Residuals sparse_residuals(const NearestPointProblem&, const Vector& q, const Vector& lambda,
                           const KnownParts&);

}  // namespace convex
