#include "convex/nearest_point/well_conditioned.hpp"

#include "convex/nearest_point/short_way.hpp"
#include "convex/nearest_point/small_way.hpp"

namespace convex {
namespace {

/// Beyond, the arrays by eights are no longer what the caches hold.
constexpr Index largest = 600;

constexpr Index most_kept_lines = Index{1} << 17;  // 8 MB

}  // namespace

bool has_short_way(const NearestPointProblem& problem) {
  const Index n = problem.dimension(), m = problem.rows();
  return problem.A.kind() == MetricKind::dense && !problem.U.is_sparse() && n > 0 && n <= largest && m > 0 &&
         m <= 4 * largest;
}

std::optional<Solution> well_conditioned(const NearestPointProblem& problem, const Accuracy& accuracy,
                                         const std::vector<Index>& guess) {
  if (!has_short_way(problem) || accuracy.step_limit > 0) return std::nullopt;
  std::optional<Solution> found(std::in_place);
  if (SmallWay::fits(problem)) {
    SmallScene scene;
    if (SmallWay(problem, scene).solve(guess, accuracy, *found)) return found;
  }
  thread_local Arena arena;
  if (!ShortWay(problem, arena).solve(guess, accuracy, *found)) found.reset();
  if (arena.lines() > most_kept_lines) arena.give_back();
  return found;
}

}  // namespace convex
