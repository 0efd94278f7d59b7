#include "convex/nearest_point/repeated_problem.hpp"

#include <algorithm>
#include <array>

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/pivoting/critical_region.hpp"
#include "convex/nearest_point/pivoting/factored_rows.hpp"
#include "convex/nearest_point/pivoting/gram_method.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"
#include "convex/nearest_point/pivoting/swept_rows.hpp"
#include "convex/nearest_point/reductions/common_size.hpp"

namespace convex {

struct RepeatedProblem::State {
  /// A working set that solves have ended with. Its critical region costs about as much as a solve for each
  /// of its columns: it is found when so many solves have ended with the set, so that it at most doubles what
  /// all have cost, whatever comes after.
  struct SetMet {
    std::vector<Index> rows;  ///< sorted
    Index solves = 0;
    std::unique_ptr<CriticalRegion> region;
    int trust = 0;  ///< the region is tried before a solve so many times more, unless it has the solution
    bool was_tried = false;
  };
  static constexpr std::size_t most_sets = 4;  ///< that are remembered, the last met first
  /// trust: of a region that has just had the solution, and of one that had not, though its set holds.
  static constexpr int most_trust = 4, least_trust = -16;

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
  std::array<SetMet, most_sets> sets;
  std::vector<Index> rows_held;
  Solution solution;

  /// The solution of the problem as it now is.
  void find();
  bool find_in_region();
  /// After a solve by an engine.
  void note_set(GramWorkingSet&);
};

RepeatedProblem::RepeatedProblem(NearestPointProblem problem, const Accuracy& accuracy) {
  validate(problem);
  if (has_gram_matrix(problem) && problem.A.kind() == MetricKind::diagonal)
    problem = with_dense_metric(std::move(problem));
  state_ = std::make_unique<State>(State{std::move(problem), accuracy, {}, {}, {}, {}, {}, {}, {}});
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

bool RepeatedProblem::State::find_in_region() {
  for (std::size_t k = 0; k < most_sets; ++k) {
    SetMet& set = sets[k];
    set.was_tried = set.region && set.trust > 0;
    if (!set.was_tried) continue;
    set.trust -= 1;
    if (!solve_in_critical_region(*set.region, problem, accuracy, solution)) continue;
    set.trust = most_trust;
    std::rotate(sets.begin(), sets.begin() + static_cast<std::ptrdiff_t>(k),
                sets.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    return true;
  }
  return false;
}

void RepeatedProblem::State::note_set(GramWorkingSet& held) {
  rows_held = solution.basis;
  std::sort(rows_held.begin(), rows_held.end());
  auto set = std::find_if(sets.begin(), sets.end(),
                          [&](const SetMet& one) { return one.solves > 0 && one.rows == rows_held; });
  if (set == sets.end()) {
    set -= 1;
    *set = SetMet{rows_held, 0, nullptr, 0, false};
  }
  std::rotate(sets.begin(), set, set + 1);
  SetMet& met = sets.front();
  met.solves += 1;
  if (met.solves == problem.dimension() + held.point().size) met.region = find_critical_region(held, problem);
  met.trust = met.was_tried ? least_trust : met.trust + 1;
}

void RepeatedProblem::State::find() {
  if (find_in_region()) return;
  const auto all_finite = dense_kernels().is_finite;
  const Vector &z = problem.z, &s = problem.s;
  if (!all_finite(z.size(), z.data()) || !all_finite(s.size(), s.data()))
    throw InvalidInput("z, s: an entry is not finite; give finite numbers");
  if (has_gram_matrix(problem) && accuracy.step_limit == 0) {
    if (SweptRows::fits(problem)) {
      if (!tableau) tableau = std::make_unique_for_overwrite<SmallTableau>();
      if (!swept || !swept->settled) swept.emplace(problem, *tableau);
      if (swept->solve(accuracy, solution)) return note_set(swept->rows);
    }
    if (factored && factored->settled && factored->solve(accuracy, solution)) return note_set(factored->rows);
    factored.emplace(problem, arena);
    if (factored->solve(accuracy, solution)) return note_set(factored->rows);
  }
  solution = active_set(problem, accuracy, solution.basis);
}

}  // namespace convex
