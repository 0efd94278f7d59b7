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
Residuals residuals(const NearestPointProblem&, const Solution&, const KnownParts& known = {});

/// q and lambda with their slacks, norms and residuals.
Solution measured(const NearestPointProblem&, const Vector& q, const Vector& lambda,
                  const KnownParts& known = {});

/// Whether a row is violated by more than the error bound allows: then one of the two is wrong, and nothing
/// is known of the error.
bool violates_beyond_bound(const Solution&);

/// A bound of ||q - q*||_A from the residuals of an answer whose doubles satisfy every row, and the rounding
/// of its terms: with r = Aq - z - Uᵀlambda, lambda >= 0 on one-sided rows, w = Uq - s and e = q - q*,
///   ||e||² = e·r + (lambda - lambda*)·(w - w*) <= ||e|| ||r||_(A⁻¹) + lambda·w,
/// since lambda*·w* = 0 <= lambda·w* and lambda*·w >= 0, whatever the rows have to do with each other. It
/// proves half of the digits. Infinite for other answers: where q violates a row, however little, there may
/// be no solution.
double bound_by_gap(const NearestPointProblem&, const Solution&);

/// ||u_a||_(A⁻¹) for the rows given, 0 for the others: m.
Vector dual_lengths(const NearestPointProblem&, const std::vector<Index>& rows);

}  // namespace convex::inline optimality
