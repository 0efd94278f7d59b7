#include "cli/measurement/exams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/measurement/peers.hpp"
#include "convex/exact/fraction.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"

namespace cli::inline measurement {
namespace {

using convex::Metric;
using convex::MetricKind;
using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;
using convex::Vector;

double multiplier_error(const Exam& exam, const Vector& lambda) {
  if (exam.multipliers.size() == 0 || lambda.size() != exam.multipliers.size()) return unknown;
  const double scale = exam.multipliers.cwiseAbs().maxCoeff();
  return scale > 0 ? (lambda - exam.multipliers).cwiseAbs().maxCoeff() / scale : unknown;
}

/// The default's answer with a proved bound, in doubles; where that proves nothing, the answer in fractions.
Solution certified(const NearestPointProblem& problem, const convex::Accuracy& accuracy) {
  Solution found = convex::automatic(problem, accuracy);
  const std::optional<double> bound = convex::enclosed_error(problem, found);
  if (bound) {
    found.error_bound = *bound;
    return found;
  }
  if (convex::exact_applies(problem).empty()) return convex::exact_method(problem, accuracy);
  found.error_bound = INFINITY;
  return found;
}

/// The methods of the table and the certified default, which no problem file names.
std::vector<convex::Method> contestants() {
  std::vector<convex::Method> all(convex::methods().begin(), convex::methods().end());
  all.push_back({"certified", "", convex::MethodKind::direct,
                 [](const NearestPointProblem&) { return std::string(); }, certified});
  return all;
}

}  // namespace

std::vector<std::string> contestant_names() {
  std::vector<std::string> names;
  for (const convex::Method& method : contestants()) names.emplace_back(method.name);
  // Of the convex layer and of other packages, where a problem has them.
  for (const char* name : {"iterative", "both-halves", "proximal-gradient", "difference", "facets"})
    names.emplace_back(name);
  for (std::string& name : peer_names()) names.push_back(std::move(name));
  return names;
}

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

namespace {

/// Of an answer to a problem that has none: how far, at least, it is from satisfying all rows. Where this is
/// within its bound, rows contradict each other by no more than rounding.
double least_violation(const NearestPointProblem& problem, const Vector& q) {
  double worst = 0;
  for (convex::Index a = 0; a < problem.rows(); ++a) {
    const double rest =
        convex::add(problem.U.dot(a, convex::DoubleDoubleVector(q)), {-problem.s[a], 0}).value();
    const double length = problem.A.dual_norm(problem.U.row(a));
    if (length > 0) worst = std::max(worst, -rest / length);
  }
  return worst;
}

void judge_infeasible(const Exam& exam, const Solution& found, Judgement& result) {
  if (found.status == Status::infeasible) {
    result.error = result.bound = 0;
    return;
  }
  result.verdict = Verdict::gave_up;
  if (found.status != Status::solved) return;
  const double scale = std::max(exam.problem.A.norm(found.q), exam.problem.A.dual_norm(exam.problem.z));
  result.error = least_violation(exam.problem, found.q) / scale;
  result.bound = found.error_bound / scale;
  result.verdict = exceeds(result.error, result.bound) ? Verdict::wrong : Verdict::ok;
}

}  // namespace

Judgement judgement(const Exam& exam, const Solution& found) {
  Judgement result;
  result.polished = found.polished;
  if (!exam.feasible) {
    judge_infeasible(exam, found, result);
    return result;
  }
  if (found.status == Status::gave_up) result.verdict = Verdict::gave_up;
  if (found.status == Status::infeasible) result.verdict = Verdict::wrong;
  if (found.q.size() != exam.solution.size()) return result;
  const Metric& A = exam.problem.A;
  const double scale =
      std::max({A.norm(exam.solution.hi), A.dual_norm(exam.problem.z), std::numeric_limits<double>::min()});
  result.error = A.norm((found.q - exam.solution.hi) - exam.solution.lo) / scale;
  result.bound = found.error_bound / scale;
  result.multiplier_error = multiplier_error(exam, found.lambda);
  if (result.verdict == Verdict::ok && !std::isfinite(result.bound)) result.verdict = Verdict::gave_up;
  if (result.verdict == Verdict::ok && exceeds(result.error, result.bound)) result.verdict = Verdict::wrong;
  return result;
}

std::vector<Contest> contests(Exam given) {
  const auto exam = std::make_shared<const Exam>(std::move(given));
  std::vector<Contest> all;
  for (const convex::Method& method : contestants()) {
    const auto found = std::make_shared<Solution>();
    const NearestPointProblem& problem = exam->problem;
    all.push_back({exam->name, problem.dimension(), problem.rows(), std::string(method.name), method.kind,
                   method.applies(problem),
                   [exam, found, solve = method.solve](const convex::Accuracy& accuracy) {
                     const NearestPointProblem& given_one = exam->problem;
                     *found = solve(
                         {anew(given_one.A), given_one.z, given_one.U, given_one.s, given_one.two_sided},
                         accuracy);
                   },
                   [exam, found] { return judgement(*exam, *found); }});
  }
  return all;
}

Exam gallery_exam(const convex::GalleryFamily& family, convex::Index size, double difficulty) {
  convex::GalleryInstance instance = convex::gallery_instance(family, size, difficulty);
  return {fmt::format("{} {:g}", family.name, difficulty),
          std::move(instance.problem),
          instance.feasible,
          std::move(instance.solution),
          {}};
}

Exam file_exam(const Scene& scene) {
  Exam exam{
      scene.title.empty() ? scene.file : scene.title, scene.problem, true, convex::DoubleDoubleVector(0), {}};
  const convex::Solution found = convex::active_set(scene.problem);
  if (scene.problem.dimension() > most_exact) {
    if (found.status == convex::Status::gave_up)
      throw convex::InvalidInput(scene.file + ": its truth is not known: the default method gave up");
    exam.feasible = found.status != convex::Status::infeasible;
    exam.solution = convex::DoubleDoubleVector(found.q);
    return exam;
  }
  const convex::ExactSolution exact =
      convex::exact_active_set(convex::exact_problem(scene.problem), found.basis);
  exam.feasible = exact.status != convex::Status::infeasible;
  if (!exam.feasible) return exam;
  exam.solution = convex::nearest_pairs(exact.q);
  const convex::Multipliers known =
      convex::multipliers(scene.problem, found, scene.solve.accuracy.tolerance, false);
  if (known.unique) exam.multipliers = convex::nearest_pairs(exact.lambda).hi;
  return exam;
}

}  // namespace cli::inline measurement
