#include "cli/measurement/trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cli/measurement/child_process.hpp"
#include "cli/measurement/stopwatch.hpp"

namespace cli {
namespace {

using convex::Index;
using convex::Metric;
using convex::MetricKind;
using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;
using convex::Vector;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A true error above so many times the method's own bound is a wrong answer.
constexpr double wrong_beyond = 10;

/// The metric made anew from its numbers, factor and all.
Metric anew(const Metric& A) {
  switch (A.kind()) {
    case MetricKind::identity:
      return Metric::identity(A.dimension());
    case MetricKind::diagonal:
      return Metric::diagonal(A.diagonal());
    case MetricKind::dense:
      return Metric::dense(A.dense_gram());
    case MetricKind::sparse:
      break;
  }
  return Metric::sparse(A.sparse_gram());
}

double multiplier_error(const Exam& exam, const Vector& lambda) {
  if (exam.multipliers.size() == 0 || lambda.size() != exam.multipliers.size()) return nan;
  const double scale = exam.multipliers.cwiseAbs().maxCoeff();
  return scale > 0 ? (lambda - exam.multipliers).cwiseAbs().maxCoeff() / scale : nan;
}

/// What the child reports: seconds (median, quartiles), repetitions, error, error of multipliers, bound, and
/// the verdict.
std::vector<double> examined(const Exam& exam, const convex::Method& method, const convex::Accuracy& accuracy,
                             const TrialLimits& limits) {
  pin_to_one_processor();
  Solution found;
  const Timing timing = timed(
      [&] {
        const NearestPointProblem fresh{anew(exam.problem.A), exam.problem.z, exam.problem.U, exam.problem.s,
                                        exam.problem.two_sided};
        found = method.solve(fresh, accuracy);
      },
      limits.budget);
  double error = nan, bound = nan, of_multipliers = nan;
  Verdict verdict = Verdict::ok;
  const bool says_infeasible = found.status == Status::infeasible;
  if (found.status == Status::gave_up) verdict = Verdict::gave_up;
  if (!exam.feasible) {
    if (says_infeasible) error = bound = 0;
    if (!says_infeasible && verdict == Verdict::ok)
      verdict = found.status == Status::solved ? Verdict::wrong : Verdict::gave_up;
  } else if (says_infeasible) {
    verdict = Verdict::wrong;
  }
  if (exam.feasible && found.q.size() == exam.solution.size()) {
    const Metric& A = exam.problem.A;
    const double scale =
        std::max({A.norm(exam.solution.hi), A.dual_norm(exam.problem.z), std::numeric_limits<double>::min()});
    const Vector missing = (found.q - exam.solution.hi) - exam.solution.lo;
    error = A.norm(missing) / scale;
    bound = found.error_bound / scale;
    of_multipliers = multiplier_error(exam, found.lambda);
    if (verdict == Verdict::ok && !std::isfinite(bound)) verdict = Verdict::gave_up;
    if (verdict == Verdict::ok && !(error <= wrong_beyond * std::max(bound, convex::unit_roundoff)))
      verdict = Verdict::wrong;
  }
  return {timing.median, timing.lower,   timing.upper, static_cast<double>(timing.repetitions),
          error,         of_multipliers, bound,        static_cast<double>(static_cast<int>(verdict))};
}

}  // namespace

std::string verdict_text(Verdict verdict) {
  constexpr std::array<const char*, 6> texts{"ok", "wrong", "gave-up", "too-slow", "refused", "crashed"};
  return texts[static_cast<std::size_t>(verdict)];
}

Trial trial(const Exam& exam, const convex::Method& method, const convex::Accuracy& accuracy,
            const TrialLimits& limits) {
  Trial result;
  result.problem = exam.name;
  result.n = exam.problem.dimension();
  result.m = exam.problem.rows();
  result.method = method.name;
  result.kind = method.kind;
  result.setting = accuracy.tolerance;
  result.polished = accuracy.polish;
  result.seconds = result.lower = result.upper = result.error = result.multiplier_error = result.bound = nan;
  if (!method.applies(exam.problem).empty()) {
    result.verdict = Verdict::refused;
    return result;
  }
  const ChildOutcome outcome =
      in_child(limits.limit + 2 * limits.budget, [&] { return examined(exam, method, accuracy, limits); });
  if (outcome.ending == Ending::too_slow) {
    result.verdict = Verdict::too_slow;
    result.seconds = limits.limit;
    return result;
  }
  if (outcome.ending == Ending::crashed || outcome.numbers.size() != 8) {
    result.verdict = Verdict::crashed;
    return result;
  }
  const std::vector<double>& numbers = outcome.numbers;
  result.seconds = numbers[0];
  result.lower = numbers[1];
  result.upper = numbers[2];
  result.repetitions = static_cast<int>(numbers[3]);
  result.error = numbers[4];
  result.multiplier_error = numbers[5];
  result.bound = numbers[6];
  result.verdict = static_cast<Verdict>(static_cast<int>(numbers[7]));
  return result;
}

}  // namespace cli
