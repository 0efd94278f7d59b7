#pragma once

#include "convex/nearest_point/reductions/scaled_problem.hpp"
#include "convex/nearest_point/sparse/regularised_kkt.hpp"

namespace convex::inline algorithms {

/// The augmented Lagrangian of a problem about multipliers lambda with weights 1/theta,
///   ½ q·Aq - z·q + Σ ½/theta (theta lambda_a + s_a - u_a·q)²₊ (no positive part on two-sided rows),
/// strongly convex and piecewise quadratic: minimised over q by Newton's method on its pieces.
class AugmentedLagrangian {
 public:
  explicit AugmentedLagrangian(const ScaledProblem&);

  Vector q, lambda;
  double theta = 1;

  /// One Newton step with the active rows of q; damped by the exact minimum along it when asked. Returns
  /// whether the active rows are those of the step before it: then q is the minimum, and `multipliers` are
  /// the next lambda.
  bool newton_step(bool damped);
  /// lambda_a + (s_a - u_a·q)/theta, its positive part on one-sided rows.
  Vector multipliers() const;

 private:
  std::vector<Index> active() const;
  double line_minimum(const Vector& direction) const;

  const ScaledProblem& scaled_;
  const NearestPointProblem& problem_;
  RegularisedKkt kkt_;
  std::vector<Index> factored_;
  double factored_theta_ = -1;
};

}  // namespace convex::inline algorithms
