#include "convex/nearest_point/proof/exact_method.hpp"

#include <cmath>
#include <compare>
#include <cstdint>
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

namespace {

/// The order of x 2^k and an integer.
std::strong_ordering order_of(double x, long k, const Integer& integer) {
  constexpr int mantissa = 53;
  int exponent = 0;
  const auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), mantissa));
  const long shift = exponent - mantissa + k;
  const auto power = [](long e) { return Integer::shifted(1, static_cast<unsigned long>(e)); };
  return shift >= 0 ? digits * power(shift) <=> integer : Integer(digits) <=> integer * power(-shift);
}

}  // namespace

Vector rounded_weights(const IntegerVector& weights, const IntegerVector& s) {
  constexpr long largest_exponent = 1000;
  long least = 0, most = 0;
  bool fit = true;
  for (const Integer& weight : weights) {
    const auto bits = static_cast<long>(weight.bits());
    if (bits == 0) continue;
    least = least == 0 ? bits : std::min(least, bits);
    most = std::max(most, bits);
    fit = fit && bits <= largest_exponent && order_of(nearest_quotient(weight, 1), 0, weight) == 0;
  }
  const long k = fit ? 0 : std::max(least - 1, most - largest_exponent);
  Vector rounded = nearest({weights, Integer::shifted(1, static_cast<unsigned long>(k))});
  for (std::size_t a = 0; a < weights.size(); ++a) {
    double& w = rounded[static_cast<Index>(a)];
    const int side = s[a].sign();
    const std::strong_ordering order = order_of(w, k, weights[a]);
    if (side > 0 && order < 0) w = std::nextafter(w, std::numeric_limits<double>::infinity());
    if (side < 0 && order > 0) w = std::nextafter(w, -std::numeric_limits<double>::infinity());
  }
  return rounded;
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
    solution.farkas = rounded_weights(exact.farkas, problem.s);
    return solution;
  }
  solution.q = nearest(exact.q);
  solution.lambda = nearest(exact.lambda);
  solution.slack.resize(problem.rows());
  for (Index a = 0; a < problem.rows(); ++a) solution.slack[a] = nearest_double(exact.slack[at(a)]);
  solution.error_bound = solution.rounding = distance_above(problem, solution.q, exact.q);
  solution.acceleration_norm = root_above(squared_norm(problem, exact.q));
  const bool finite =
      solution.q.allFinite() && solution.lambda.allFinite() && std::isfinite(solution.acceleration_norm);
  solution.status = solution.is_within(accuracy) && finite ? Status::solved : Status::inaccurate;
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
  solution.residuals = residuals(problem, solution.q, solution.lambda);
  return solution;
}

}  // namespace convex::inline proof
