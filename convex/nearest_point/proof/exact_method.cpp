#include "convex/nearest_point/proof/exact_method.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "convex/exact/elimination.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"

namespace convex::inline proof {

std::vector<Index> likely_active_rows(const NearestPointProblem& problem) {
  const Solution solution = active_set(problem, {.limit = 0});
  if (solution.farkas.size() == 0) return solution.basis;
  std::vector<Index> rows = problem.two_sided;
  for (Index a = 0; a < problem.rows(); ++a)
    if (solution.farkas[a] > 0) rows.push_back(a);
  return rows;
}

Vector rounded_weights(const IntegerVector& weights) {
  constexpr std::size_t mantissa = 53;
  Integer smallest = 0;
  bool fit = true;
  for (const Integer& weight : weights) {
    const Integer size = weight.sign() < 0 ? -weight : weight;
    fit = fit && size.bits() <= mantissa;
    if (!size.is_zero() && (smallest.is_zero() || size < smallest)) smallest = size;
  }
  return nearest({weights, fit ? Integer(1) : smallest});
}

double distance_above(const ExactProblem& problem, const Vector& x, const ExactVector& q) {
  if (!x.allFinite()) return std::numeric_limits<double>::infinity();
  return root_above(squared_distance(problem, exact_vector(x), q));
}

Solution rounded(const ExactProblem& problem, const ExactSolution& exact, const Accuracy& accuracy) {
  Solution solution;
  solution.method = "exact";
  solution.status = exact.status;
  solution.steps = exact.steps;
  solution.basis = exact.basis;
  if (exact.status == Status::infeasible) {
    solution.farkas = rounded_weights(exact.farkas);
    return solution;
  }
  solution.q = nearest(exact.q);
  solution.lambda = nearest(exact.lambda);
  solution.slack.resize(problem.rows());
  for (Index a = 0; a < problem.rows(); ++a)
    solution.slack[a] = nearest_double(exact.slack[static_cast<std::size_t>(a)]);
  solution.error_bound = solution.rounding = distance_above(problem, solution.q, exact.q);
  solution.acceleration_norm = root_above(squared_norm(problem, exact.q));
  const bool close = solution.error_bound <= accuracy.tolerance * std::max(1.0, solution.acceleration_norm);
  const bool finite =
      solution.q.allFinite() && solution.lambda.allFinite() && std::isfinite(solution.acceleration_norm);
  solution.status = close && finite ? Status::solved : Status::inaccurate;
  return solution;
}

std::string exact_applies(const NearestPointProblem& problem) {
  constexpr Index most_entries = 1000000;
  const Index n = problem.dimension(), entries = n * (n + problem.rows());
  if (entries <= most_entries) return {};
  return "its fractions take too long for " + std::to_string(n) + " coordinates and " +
         std::to_string(problem.rows()) + " rows; --certify proves the answer of another method";
}

Solution exact_method(const NearestPointProblem& problem, const Accuracy& accuracy) {
  validate(problem);
  const ExactProblem exact = exact_problem(problem);
  Solution solution = rounded(exact, exact_active_set(exact, likely_active_rows(problem)), accuracy);
  if (solution.q.size() == 0) return solution;
  solution.force_norm = problem.A.dual_norm(problem.z);
  solution.residuals = residuals(problem, solution.q, solution.lambda, Vector::Zero(problem.rows()));
  return solution;
}

}  // namespace convex::inline proof
