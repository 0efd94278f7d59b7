#include "cli/measurement/trial.hpp"

#include <algorithm>

#include "cli/measurement/child_process.hpp"
#include "cli/measurement/stopwatch.hpp"

namespace cli::inline measurement {
namespace {

/// What the child reports.
std::vector<double> measured(const Contest& contest, const convex::Accuracy& accuracy,
                             const TrialLimits& limits) {
  pin_to_one_processor();
  const Timing timing = timed([&] { contest.work(accuracy); }, limits.budget);
  const Judgement judgement = contest.judged();
  return {timing.median,
          timing.lower,
          timing.upper,
          static_cast<double>(timing.repetitions),
          judgement.error,
          judgement.multiplier_error,
          judgement.bound,
          judgement.polished ? 1.0 : 0.0,
          static_cast<double>(static_cast<int>(judgement.verdict))};
}

}  // namespace

Trial trial(const Contest& contest, const convex::Accuracy& accuracy, const TrialLimits& limits) {
  Trial result;
  result.problem = contest.problem;
  result.n = contest.n;
  result.m = contest.m;
  result.method = contest.method;
  result.kind = contest.kind;
  result.setting = accuracy.tolerance;
  Judgement& judgement = result.judgement;
  if (!contest.refused.empty()) {
    judgement.verdict = Verdict::refused;
    return result;
  }
  const ChildOutcome outcome =
      in_child(limits.limit + 2 * limits.budget, [&] { return measured(contest, accuracy, limits); });
  if (outcome.ending == Ending::too_slow) {
    judgement.verdict = Verdict::too_slow;
    result.seconds = limits.limit;
    return result;
  }
  const std::vector<double>& numbers = outcome.numbers;
  if (outcome.ending != Ending::done || numbers.size() != 9) {
    judgement.verdict = Verdict::crashed;
    return result;
  }
  result.seconds = numbers[0];
  result.lower = numbers[1];
  result.upper = numbers[2];
  result.repetitions = static_cast<int>(numbers[3]);
  judgement = {static_cast<Verdict>(static_cast<int>(numbers[8])), numbers[4], numbers[5], numbers[6],
               numbers[7] > 0.5};
  return result;
}

}  // namespace cli::inline measurement
