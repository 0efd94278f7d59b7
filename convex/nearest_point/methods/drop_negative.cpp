#include "convex/nearest_point/methods/every_method.hpp"

#include "convex/nearest_point/methods/crossover.hpp"
#include "convex/nearest_point/optimality/refinement.hpp"

namespace convex::inline algorithms {
namespace {

/// A row this close to the span of others is taken to depend on them.
constexpr double dependence = 1e-10;

/// A multiplier is negative beyond this part of the largest one.
constexpr double noise = 1e-12;

struct Held {
  Vector q, lambda;
};

/// All the rows given with equality, as far as they are independent.
Held hold(const NearestPointProblem& problem, const std::vector<Index>& rows) {
  WorkingSet set(problem);
  set.append_block(rows, dependence);
  set.solve();
  const RefinedPoint refined = refine(set);
  Held held{refined.q.hi, Vector::Zero(problem.rows())};
  for (Index k = 0; k < set.size(); ++k) held.lambda[set.rows()[at(k)]] = refined.lambda.hi[k];
  return held;
}

}  // namespace

Solution drop_negative(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const auto found = without_a_method(problem, "drop-negative", accuracy)) return *found;
  const std::vector<Index> rows = indices_below(problem.rows());
  const Held first = hold(problem, rows);
  const Vector length = problem.U.lengths(problem.A.diagonal().cwiseInverse());
  const double least = -noise * first.lambda.cwiseProduct(length).cwiseAbs().maxCoeff();
  std::vector<Index> kept = problem.two_sided;
  for (Index a : rows)
    if (first.lambda[a] * length[a] >= least && !problem.is_two_sided(a)) kept.push_back(a);
  const Held second = hold(problem, kept);
  Candidate candidate{.method = "drop-negative", .q = second.q, .lambda = second.lambda, .farkas = {}};
  candidate.steps = problem.rows() - static_cast<Index>(kept.size());
  candidate.may_polish = false;
  return crossover(problem, candidate, accuracy);
}

}  // namespace convex::inline algorithms
