#include "convex/nearest_point/repeated_problem.hpp"

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/pivoting/factored_rows.hpp"
#include "convex/nearest_point/pivoting/gram_method.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"
#include "convex/nearest_point/pivoting/swept_rows.hpp"

namespace convex {

struct RepeatedProblem::State {
  /// A working set and what is decided on it; settled: it ended with rows to begin from.
  template <class Rows>
  struct Engine {
    template <class Room>
    Engine(const NearestPointProblem& problem, Room& room) : rows(problem, room) {}
    bool solve(const Accuracy& accuracy, Solution& solution) {
      settled = settled ? decisions.solve_again(accuracy, solution) : decisions.solve({}, accuracy, solution);
      return settled && solution.status == Status::solved;
    }
    Rows rows;
    GramSolve decisions{rows};
    bool settled = false;
  };

  NearestPointProblem problem;
  Accuracy accuracy;
  std::unique_ptr<SmallTableau> tableau;
  std::optional<Engine<SweptRows>> swept;
  Arena arena;
  std::optional<Engine<FactoredRows>> factored;
  Solution solution;
};

RepeatedProblem::RepeatedProblem(NearestPointProblem problem, const Accuracy& accuracy) {
  validate(problem);
  if (has_gram_matrix(problem) && problem.A.kind() == MetricKind::diagonal)
    problem = with_dense_metric(std::move(problem));
  state_ = std::make_unique<State>(State{std::move(problem), accuracy, {}, {}, {}, {}, {}});
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
  if (state.swept && state.swept->settled &&
      state.swept->decisions.solve_in_critical_region(state.accuracy, state.solution))
    return state.solution;
  const auto all_finite = dense_kernels().is_finite;
  if (!all_finite(z.size(), z.data()) || !all_finite(s.size(), s.data()))
    throw InvalidInput("z, s: an entry is not finite; give finite numbers");
  if (has_gram_matrix(state.problem) && state.accuracy.step_limit == 0) {
    if (SweptRows::fits(state.problem)) {
      if (!state.tableau) state.tableau = std::make_unique_for_overwrite<SmallTableau>();
      if (!state.swept || !state.swept->settled) state.swept.emplace(state.problem, *state.tableau);
      if (state.swept->solve(state.accuracy, state.solution)) return state.solution;
    }
    if (state.factored && state.factored->settled && state.factored->solve(state.accuracy, state.solution))
      return state.solution;
    state.factored.emplace(state.problem, state.arena);
    if (state.factored->solve(state.accuracy, state.solution)) return state.solution;
  }
  state.solution = active_set(state.problem, state.accuracy, state.solution.basis);
  return state.solution;
}

}  // namespace convex
