#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline optimality {

/// Judges q and lambda, as they stand, by the residuals of `Residuals`; whoever found them is judged by this
/// one piece of code. Sums are in twice the working precision.
Residuals residuals(const NearestPointProblem&, const Vector& q, const Vector& lambda);

/// What else is known of an answer.
struct KnownParts {
  Vector length = {};                       ///< ||u_a||_(A⁻¹), 0 where it is not known: m; may be empty
  Vector magnitude = {};                    ///< at least Σ_i |u_ai q_i| of every row, m; may be empty
  std::optional<double> stationarity = {};  ///< ||Aq - z - Uᵀlambda||_(A⁻¹), sums in twice the precision
};
/// The same for an answer with its norms and slacks, Uq - s as doubles give it; those near zero are computed
/// again.
Residuals residuals(const NearestPointProblem&, const Solution&, KnownParts known = {});

/// `residuals` for a diagonal A and sparse rows: the same numbers from one pass over the rows, without lists.
/// Lengths are computed, whether known or not.
Residuals sparse_residuals(const NearestPointProblem&, const Solution&);

/// The same where ||Aq - z - Uᵀlambda||_(A⁻¹) is known; only the rows first … end - 1 may leave anything.
Residuals sparse_residuals(const NearestPointProblem&, const Solution&, double unbalanced, Index first,
                           Index end);

/// Whether a row is violated by more than the error bound allows: then one of the two is wrong, and nothing
/// is known of the error.
bool violates_beyond_bound(const Solution&);

/// A bound of ||q - q*||_A from the residuals of an answer whose doubles satisfy every row: with lambda >= 0
/// on one-sided rows, ½||q - q*||_A² <= lambda·(Uq - s) + ½||Aq - z - Uᵀlambda||²_(A⁻¹), the duality gap,
/// whatever the rows have to do with each other; and the rounding of these terms. Infinite for other answers.
double bound_by_gap(const NearestPointProblem&, const Solution&);

/// ||u_a||_(A⁻¹) for the rows given, 0 for the others: m.
Vector dual_lengths(const NearestPointProblem&, const std::vector<Index>& rows);

}  // namespace convex::inline optimality
