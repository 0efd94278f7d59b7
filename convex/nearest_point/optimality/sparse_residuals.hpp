#pragma once

#include "convex/nearest_point/optimality/residuals.hpp"

namespace convex::inline optimality {

/// `residuals` for a diagonal A and sparse rows: the same numbers from one pass over the rows, without lists.
/// Lengths are computed, whether known or not.
Residuals sparse_residuals(const NearestPointProblem&, const Vector& q, const Vector& lambda,
                           const KnownParts&);

/// ||q||_A, ||z||_(A⁻¹) and ||Aq - z - Uᵀlambda||_(A⁻¹).
struct KnownNorms {
  double q = 0, z = 0, unbalanced = 0;
};

/// The same where these are known; only the rows first … end - 1 may leave anything.
Residuals sparse_residuals(const NearestPointProblem&, const Vector& q, const Vector& lambda,
                           const Vector& slack, const KnownNorms&, Index first, Index end);

}  // namespace convex::inline optimality
