#pragma once

#include "convex/nearest_point/methods/crossover.hpp"
#include "convex/nearest_point/reductions/scaled_problem.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::inline algorithms {

/// Multiplications that all steps together may cost.
inline constexpr double most_work = 2e10;

/// Steps of which each takes two products with a matrix of the rows, or so much work where that is sparse.
inline Index affordable_steps(const NearestPointProblem& problem, Index most, double when_sparse) {
  const double dense = 4 * static_cast<double>(problem.rows()) * static_cast<double>(problem.dimension());
  return std::min(most, static_cast<Index>(most_work / (is_dense_size(problem) ? dense : when_sparse)) + 8);
}

/// What a method has found, from a point of the original problem, multipliers of scaled rows, and weights of
/// these.
inline Candidate unscaled(std::string_view method, const ScaledRows& scaled, const Vector& q, const Vector& y,
                          const Vector& weights) {
  return {.method = method, .q = q, .lambda = scaled.multipliers(y), .farkas = scaled.weights(weights)};
}

/// Runs step(k) for k = 1 … limit and has what read(k) gives, a Candidate, judged now and then, more and more
/// seldom; also when step returns true, for a stop test of its own. Ends with the first candidate that is
/// solved or infeasible, or with the last one, not finished. step_limit of the accuracy, when given, replaces
/// `limit`.
template <class Step, class Read>
Solution iterate(const NearestPointProblem& problem, const Accuracy& accuracy, Index limit, Step step,
                 Read read) {
  constexpr Index first = 8;      // steps before the first judgement
  constexpr double growth = 1.5;  // of the steps between judgements
  if (accuracy.step_limit > 0) limit = accuracy.step_limit;
  Index next = first;
  for (Index k = 1; k <= limit; ++k) {
    const bool stops = step(k);
    if (!stops && k < next && k < limit) continue;
    next = static_cast<Index>(growth * static_cast<double>(std::max(k, next)));
    Candidate candidate = read(k);
    candidate.steps = k;
    candidate.finished = false;
    Solution found = crossover(problem, candidate, accuracy);
    if (found.status == Status::solved || found.status == Status::infeasible || k == limit) return found;
  }
  return {};
}

}  // namespace convex::inline algorithms
