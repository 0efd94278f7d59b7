#include "convex/nearest_point/active_set/gram_method.hpp"

#include "convex/nearest_point/active_set/active_set_answer.hpp"
#include "convex/nearest_point/pivoting/factored_rows.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"
#include "convex/nearest_point/pivoting/swept_rows.hpp"

namespace convex::inline dual_active_set {
namespace {

/// Beyond, the arrays by eights are no longer what the caches hold.
constexpr Index largest = 600;

constexpr Index most_kept_lines = Index{1} << 17;  // 8 MB

}  // namespace

bool has_gram_matrix(const NearestPointProblem& problem) {
  const Index n = problem.dimension(), m = problem.rows();
  return (problem.A.kind() == MetricKind::dense || problem.A.kind() == MetricKind::diagonal) &&
         !problem.U.is_sparse() && n > 0 && n <= largest && m > 0 && m <= 4 * largest;
}

NearestPointProblem with_dense_metric(NearestPointProblem problem) {
  problem.A = Metric::dense(Matrix(problem.A.diagonal().asDiagonal()));
  return problem;
}

GramOutcome solve_by_gram_matrix(const NearestPointProblem& problem, const Accuracy& accuracy,
                                 const std::vector<Index>& guess) {
  GramOutcome found;
  found.rows = guess;
  if (!has_gram_matrix(problem) || accuracy.step_limit > 0) return found;
  if (problem.A.kind() == MetricKind::diagonal) {
    found = solve_by_gram_matrix(with_dense_metric(problem), accuracy, guess);
    return found;
  }
  Solution& solution = found.solution;
  const auto is_solved_by = [&](GramWorkingSet& set) {
    if (GramSolve(set).solve(found.rows, accuracy, solution) && solution.status == Status::solved)
      return true;
    const std::optional<Vector> weights = set.contradiction();
    if (weights)
      solution = infeasible_answer(problem, *weights, set.point().norm(), set.point().steps, accuracy);
    found.rows = set.one_sided_working_set();
    return weights && solution.status == Status::infeasible;
  };
  if (SweptRows::fits(problem)) {
    thread_local const auto tableau = std::make_unique_for_overwrite<SmallTableau>();
    SweptRows swept(problem, *tableau);
    found.is_answer = is_solved_by(swept);
    if (found.is_answer) return found;
  }
  thread_local Arena arena;
  FactoredRows factored(problem, arena);
  found.is_answer = is_solved_by(factored);
  if (arena.lines() > most_kept_lines) arena.give_back();
  return found;
}

}  // namespace convex::inline dual_active_set
