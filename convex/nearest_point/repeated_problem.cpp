#include "convex/nearest_point/repeated_problem.hpp"

#include <algorithm>
#include <array>

#include "convex/counted.hpp"
#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/active_set/gram_method.hpp"
#include "convex/nearest_point/common_size.hpp"
#include "convex/nearest_point/pivoting/critical_region.hpp"
#include "convex/nearest_point/pivoting/factored_rows.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"
#include "convex/nearest_point/pivoting/swept_rows.hpp"

namespace convex {

struct RepeatedProblem::State {
  /// A working set that solves have ended with, and z and s of the last. Its critical region costs about as
  /// much as a solve for each of its columns: it is found when so many solves have ended with the set, so
  /// that it at most doubles what all have cost, whatever comes after.
  struct SetMet {
    std::vector<Index> rows;  ///< sorted
    Index solves = 0;
    std::unique_ptr<CriticalRegion> region;
    Vector z, s;
    int trust = 0;  ///< the region is tried where it is positive: 1 up where the set holds again, 1 down
  };
  static constexpr std::size_t most_sets = 8;  ///< that are remembered, the last met first
  /// trust: the most, and that of a region which did not have the solution, though its set holds.
  static constexpr int most_trust = 4, least_trust = -16;
  /// Cache lines of all regions together: beyond what a second cache has they are no quicker than solves.
  static constexpr Index most_lines = 1 << 15;

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
  SetMet *tried = nullptr, *last = nullptr;  ///< whose region was tried in this solve; of the solve before
  std::vector<Index> working_set;
  Solution solution;

  /// The solution of the problem as it now is.
  void find();
  bool find_in_region();
  SetMet* likely_set();
  /// After a solve by an engine.
  void note_set(GramWorkingSet&);
};

RepeatedProblem::RepeatedProblem(NearestPointProblem problem, const Accuracy& accuracy) {
  validate(problem);
  if (has_gram_matrix(problem) && problem.A.kind() == MetricKind::diagonal)
    problem = with_dense_metric(std::move(problem));
  state_ = std::make_unique<State>(State{std::move(problem), accuracy, {}, {}, {}, {}, {}, {}, {}, {}, {}});
}

RepeatedProblem::~RepeatedProblem() = default;
RepeatedProblem::RepeatedProblem(RepeatedProblem&&) noexcept = default;
RepeatedProblem& RepeatedProblem::operator=(RepeatedProblem&&) noexcept = default;

const Solution& RepeatedProblem::solve(const Vector& z, const Vector& s) {
  State& state = *state_;
  if (z.size() != state.problem.dimension() || s.size() != state.problem.rows())
    throw InvalidInput("z, s: " + std::to_string(z.size()) + " and " + counted(s.size(), "entry", "entries") +
                       "; give one per coordinate and one per row");
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

/// The set whose last problem is much nearer to this one than those of all others, by the changes of z and s
/// as parts of them; else of the sets whose regions are trusted that which most solves have ended with.
RepeatedProblem::State::SetMet* RepeatedProblem::State::likely_set() {
  constexpr double much = 0x1p-4;  // of the squared distance
  SetMet *likely = nullptr, *nearest = nullptr;
  for (SetMet& set : sets)
    if (set.trust > 0 && set.region && (likely == nullptr || set.solves > likely->solves)) likely = &set;
  if (sets[1].solves == 0) return likely;
  const double of_z = 1 / (problem.z.squaredNorm() + 1e-300), of_s = 1 / (problem.s.squaredNorm() + 1e-300);
  double least = infinity, next = infinity;
  for (SetMet& set : sets) {
    if (set.solves == 0) break;
    const double at = of_z * (set.z - problem.z).squaredNorm() + of_s * (set.s - problem.s).squaredNorm();
    next = std::min(next, std::max(at, least));
    if (at < least) nearest = &set;
    least = std::min(least, at);
  }
  if (!(least < much * next)) return likely;
  return nearest->region && nearest->trust >= 0 ? nearest : nullptr;
}

bool RepeatedProblem::State::find_in_region() {
  tried = likely_set();
  if (tried == nullptr) return false;
  if (!solve_in_critical_region(*tried->region, problem, accuracy, solution)) {
    tried->trust = std::max(0, tried->trust - 1);
    return false;
  }
  if (tried == last) tried->trust = std::min(tried->trust + 1, most_trust);
  last = tried;
  tried->solves += 1;
  if (sets[1].solves == 0) return true;  // there is no choice
  tried->z = problem.z;
  tried->s = problem.s;
  return true;
}

void RepeatedProblem::State::note_set(GramWorkingSet& held) {
  working_set = solution.basis;
  std::sort(working_set.begin(), working_set.end());
  auto set = std::find_if(sets.begin(), sets.end(),
                          [&](const SetMet& one) { return one.solves > 0 && one.rows == working_set; });
  if (set == sets.end()) {
    set -= 1;
    *set = SetMet{working_set, 0, nullptr, {}, {}, 0};
    tried = last = nullptr;  // one of them may have been the set forgotten
  }
  if (set == tried)
    set->trust = least_trust;
  else if (set->trust < 0 || set == last)
    set->trust += 1;
  set->z = problem.z;
  set->s = problem.s;
  std::rotate(sets.begin(), set, set + 1);
  SetMet& met = sets.front();
  last = &met;
  met.solves += 1;
  if (met.solves != problem.dimension() + held.point().size) return;
  Index lines = CriticalRegion::lines(held.point());
  for (const SetMet& one : sets) lines += one.region ? one.region->arena.lines() : 0;
  if (lines <= most_lines) met.region = find_critical_region(held, problem);
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
