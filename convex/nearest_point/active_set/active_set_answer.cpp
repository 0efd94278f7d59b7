#include "convex/nearest_point/active_set/active_set_answer.hpp"

#include <cmath>
#include <limits>

#include "convex/infinity.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/optimality/farkas.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/proof/infeasibility_proof.hpp"
#include "convex/nearest_point/reductions/left_out.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline dual_active_set {

Solution active_set(const NearestPointProblem& problem, const Accuracy& accuracy,
                    const std::vector<Index>& guess) {
  validate(problem);
  validate_guess(problem, guess);
  return active_set_of_valid(problem, accuracy, guess);
}
namespace {

constexpr std::string_view method = "active-set";

/// The largest distance from a row that is not held and is violated: its slack over its length.
double farthest_beyond(const WorkingSet& set, const Vector& slack) {
  const NearestPointProblem& problem = set.problem();
  Vector beyond = (-slack).cwiseMax(0);
  for (Index a : problem.two_sided) beyond[a] = std::abs(slack[a]);
  for (Index a : set.rows()) beyond[a] = 0;
  std::vector<Index> violated;
  for (Index a = 0; a < problem.rows(); ++a)
    if (beyond[a] > 0) violated.push_back(a);
  const Vector length = dual_lengths(problem, violated);
  double farthest = 0;
  for (Index a : violated) farthest = std::max(farthest, beyond[a] / length[a]);
  return farthest;
}

}  // namespace

Solution certified_answer(const WorkingSet& set, const RefinedPoint& refined, const Vector& slack,
                          const Vector& row_scale, double left_outside, const Accuracy& accuracy,
                          Index steps) {
  const NearestPointProblem& problem = set.problem();
  Solution solution;
  solution.method = method;
  solution.steps = steps;
  solution.q = refined.q.hi;
  solution.lambda = Vector::Zero(problem.rows());
  Vector length = Vector::Zero(problem.rows());
  for (Index k = 0; k < set.size(); ++k) {
    const Index a = set.rows()[at(k)];
    solution.lambda[a] = set.one_sided(k) ? std::max(0.0, refined.lambda.hi[k]) : refined.lambda.hi[k];
    length[a] = set.factor().length(k);
  }
  solution.basis = set.rows();
  solution.slack = slack;
  solution.acceleration_norm = problem.A.norm(solution.q);
  solution.force_norm = set.w_free().norm();
  const double diagonal_norm = std::sqrt(problem.A.diagonal().dot(solution.q.cwiseAbs2()));
  solution.residuals =
      residuals(problem, solution, {.length = std::move(length), .magnitude = row_scale * diagonal_norm});

  solution.rounding = problem.A.norm(refined.q.lo);
  double multipliers = 0,
         taken_for_zero = 0;  // multipliers that rounding made negative: q solves another problem
  for (Index k = 0; k < set.size(); ++k) {
    const double multiplier = refined.lambda.hi[k] * set.factor().length(k);
    multipliers += std::abs(multiplier);
    if (set.one_sided(k)) taken_for_zero += std::max(0.0, -multiplier);
  }
  solution.error_bound =
      2 * refined.remaining() + refined.dropped + taken_for_zero + solution.rounding +
      farthest_beyond(set, slack) * set.factor().inverse_norm() +
      (left_outside > 0 ? left_outside * std::max(multipliers, std::numeric_limits<double>::min()) : 0);
  if (!problem.radii && !problem.U.is_sparse() && violates_beyond_bound(solution))
    solution.error_bound = infinity;
  solution.status = solution.is_within(accuracy) ? Status::solved : Status::inaccurate;
  return solution;
}

Solution infeasible_answer(const NearestPointProblem& problem, const Vector& weights, double scale,
                           Index steps, const Accuracy& accuracy) {
  Solution solution;
  solution.method = method;
  solution.steps = steps;
  solution.status = Status::infeasible;
  if (problem.radii) {
    if (!proves_infeasibility(problem, weights, farthest_motion * scale)) solution.status = Status::gave_up;
  } else if (std::optional<InfeasibilityProof> proof =
                 infeasibility_proof(problem, weights, accuracy.limit > 0)) {
    solution.farkas = std::move(proof->farkas);
    return solution;
  } else {
    solution.status = Status::gave_up;
    solution.undecided = open_question::contradiction;
  }
  // The smallest weight is 1: combinations of whole rows read as whole numbers.
  solution.farkas = weights / (weights.array() != 0).select(weights.cwiseAbs(), INFINITY).minCoeff();
  return solution;
}

std::optional<Vector> contradiction_within_radii(const NearestPointProblem& problem, const Vector& w) {
  std::vector<Index> rows;
  for (Index a = 0; a < w.size(); ++a)
    if (w[a] != 0) rows.push_back(a);
  const Solution found = active_set_of_valid(with_rows(problem, rows), {}, {});
  if (found.status != Status::infeasible) return std::nullopt;
  Vector weights = Vector::Zero(problem.rows());
  weights(rows) = found.farkas;
  return weights;
}

}  // namespace convex::inline dual_active_set
