#include "convex/nearest_point/proof/decided_in_fractions.hpp"

#include <algorithm>

#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"

namespace convex {
namespace {

std::vector<Index> rows_of(const NearestPointProblem& problem, const Solution& open) {
  std::vector<Index> rows = problem.two_sided;
  const auto add = [&](Index a) {
    if (std::find(rows.begin(), rows.end(), a) == rows.end()) rows.push_back(a);
  };
  for (Index a : open.basis) add(a);
  if (open.farkas.size() == problem.rows())
    for (Index a = 0; a < problem.rows(); ++a)
      if (open.farkas[a] > 0) add(a);
  return rows;
}

Solution left_open(Solution open) {
  if (open.status == Status::solved) open.status = Status::inaccurate;
  if (open.status == Status::infeasible) open.status = Status::gave_up;
  return open;
}

}  // namespace

Solution decided_in_fractions(const NearestPointProblem& problem, Solution open, const Accuracy& accuracy) {
  if (open.undecided.empty() || problem.radii) return open;
  // Asked for more than doubles can hold: fractions, rounded, would be no better.
  constexpr double few_ulps = 4 * unit_roundoff;
  if (open.undecided == open_question::conditioning &&
      open.error_bound <= few_ulps * open.acceleration_norm && open.status == Status::inaccurate)
    return open;
  const double most = accuracy.limit * most_word_operations;
  // Sizes alone may tell that it is too much, before any number is converted.
  const double n = static_cast<double>(problem.dimension());
  if (n * n * n > most) return left_open(std::move(open));
  const ExactProblem exact = exact_problem(problem);
  const ExactSolution found = exact_active_set(exact, rows_of(problem, open), most);
  if (found.status == Status::gave_up) return left_open(std::move(open));
  Solution solution = rounded(exact, found, accuracy);
  solution.method = open.method;
  solution.steps += open.steps;
  solution.force_norm = problem.A.dual_norm(problem.z);
  if (found.status != Status::infeasible)
    solution.residuals = residuals(problem, solution.q, solution.lambda, Vector::Zero(problem.rows()));
  solution.model.islands = {{open.method, problem.dimension(), problem.rows(), 0, found.word_operations,
                             n * n / 2, open.undecided}};
  return solution;
}

}  // namespace convex
