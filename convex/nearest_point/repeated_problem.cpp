#include "convex/nearest_point/repeated_problem.hpp"

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/pivoting/gram_method.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"
#include "convex/nearest_point/pivoting/small_gram_solve.hpp"

namespace convex {

struct RepeatedProblem::State {
  NearestPointProblem problem;
  Accuracy accuracy;
  Arena arena;
  std::optional<GramSolve> gram;
  std::unique_ptr<SmallTableau> tableau;
  std::optional<SmallGramSolve> small_gram;
  bool settled = false, small_settled = false;  // each ended with rows to begin from
  Solution solution;
};

RepeatedProblem::RepeatedProblem(NearestPointProblem problem, const Accuracy& accuracy) {
  validate(problem);
  if (has_gram_matrix(problem) && problem.A.kind() == MetricKind::diagonal)
    problem = with_dense_metric(std::move(problem));
  state_ = std::make_unique<State>(State{std::move(problem), accuracy, {}, {}, {}, {}, false, false, {}});
}

RepeatedProblem::~RepeatedProblem() = default;
RepeatedProblem::RepeatedProblem(RepeatedProblem&&) noexcept = default;
RepeatedProblem& RepeatedProblem::operator=(RepeatedProblem&&) noexcept = default;

const Solution& RepeatedProblem::solve(const Vector& z, const Vector& s) {
  State& state = *state_;
  if (z.size() != state.problem.dimension() || s.size() != state.problem.rows())
    throw InvalidInput("z, s: " + std::to_string(z.size()) + " and " + std::to_string(s.size()) +
                       " entries; give one per coordinate and one per row");
  state.problem.z = z;
  state.problem.s = s;
  if (state.small_settled && state.small_gram->solve_on_affine_piece(state.accuracy, state.solution))
    return state.solution;
  const auto all_finite = dense_kernels().is_finite;
  if (!all_finite(z.size(), z.data()) || !all_finite(s.size(), s.data()))
    throw InvalidInput("z, s: an entry is not finite; give finite numbers");
  if (has_gram_matrix(state.problem) && state.accuracy.step_limit == 0) {
    if (SmallGramSolve::fits(state.problem)) {
      if (!state.small_settled) {
        if (!state.tableau) state.tableau = std::make_unique<SmallTableau>();
        state.small_gram.emplace(state.problem, *state.tableau);
        state.small_settled = state.small_gram->solve({}, state.accuracy, state.solution);
      } else {
        state.small_settled = state.small_gram->solve_again(state.accuracy, state.solution);
      }
      if (state.small_settled && state.solution.status == Status::solved) return state.solution;
    }
    if (state.settled && state.gram->solve_again(state.accuracy, state.solution) &&
        state.solution.status == Status::solved)
      return state.solution;
    state.gram.emplace(state.problem, state.arena);
    state.settled = state.gram->solve({}, state.accuracy, state.solution);
    if (state.settled && state.solution.status == Status::solved) return state.solution;
  }
  state.solution = active_set(state.problem, state.accuracy, state.solution.basis);
  return state.solution;
}

}  // namespace convex
