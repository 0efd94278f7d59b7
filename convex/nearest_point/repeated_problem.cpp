#include "convex/nearest_point/repeated_problem.hpp"

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/pivoting/factored_rows.hpp"
#include "convex/nearest_point/pivoting/gram_method.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"
#include "convex/nearest_point/pivoting/swept_rows.hpp"
#include "convex/nearest_point/reductions/common_size.hpp"

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

  /// The solution of the problem as it now is.
  void find();
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
  state.find();
  if (is_beyond_squares(state.problem, state.solution))
    take_own_size(
        state.problem, state.accuracy,
        [](const NearestPointProblem& problem, const Accuracy& accuracy) {
          return active_set(problem, accuracy);
        },
        state.solution);
  return state.solution;
}

void RepeatedProblem::State::find() {
  if (swept && swept->settled && swept->decisions.solve_in_critical_region(accuracy, solution)) return;
  const auto all_finite = dense_kernels().is_finite;
  const Vector &z = problem.z, &s = problem.s;
  if (!all_finite(z.size(), z.data()) || !all_finite(s.size(), s.data()))
    throw InvalidInput("z, s: an entry is not finite; give finite numbers");
  if (has_gram_matrix(problem) && accuracy.step_limit == 0) {
    if (SweptRows::fits(problem)) {
      if (!tableau) tableau = std::make_unique_for_overwrite<SmallTableau>();
      if (!swept || !swept->settled) swept.emplace(problem, *tableau);
      if (swept->solve(accuracy, solution)) return;
    }
    if (factored && factored->settled && factored->solve(accuracy, solution)) return;
    factored.emplace(problem, arena);
    if (factored->solve(accuracy, solution)) return;
  }
  solution = active_set(problem, accuracy, solution.basis);
}

}  // namespace convex
