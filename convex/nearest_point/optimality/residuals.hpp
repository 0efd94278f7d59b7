#pragma once

#include <functional>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline optimality {

/// Judges q and lambda, as they stand, by the residuals of `Residuals`; whoever found them is judged by this
/// one piece of code. `length` has ||u_a||_(A⁻¹) where it is known, else 0. Sums are in twice the working
/// precision.
Residuals residuals(const NearestPointProblem&, const Vector& q, const Vector& lambda, const Vector& length);

/// The same for somebody who has the norms and slacks at hand. `slack`: Uq - s as doubles give it; those near
/// zero are computed again.
struct KnownParts {
  Vector length, slack;
  Vector magnitude;       ///< at least Σ_i |u_ai q_i| of every row, m; may be empty
  double q_norm = 0;      ///< ||q||_A
  double force_norm = 0;  ///< ||z||_(A⁻¹)
  std::function<double(const Vector&)> dual_norm = {};  ///< ||c||_(A⁻¹) without A's factor; may be empty
};
Residuals residuals(const NearestPointProblem&, const Vector& q, const Vector& lambda, KnownParts known);

/// ||u_a||_(A⁻¹) for the rows given, 0 for the others: m.
Vector dual_lengths(const NearestPointProblem&, const std::vector<Index>& rows);

}  // namespace convex::inline optimality
