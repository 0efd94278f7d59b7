#include "cli/resolved_scene.hpp"

#include <algorithm>
#include <cmath>

#include "cli/report/solve_report.hpp"
#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "mechanics/cancelling_gradients.hpp"
#include "mechanics/evaluation_error.hpp"
#include "mechanics/exact_text.hpp"
#include "mechanics/proof_as_written.hpp"
#include "mechanics/rounded_data.hpp"
#include "mechanics/singular/resolution.hpp"
#include "mechanics/touching_contacts.hpp"

namespace cli {

namespace {

/// Numbers between this and its inverse can be squared and multiplied a few times over.
constexpr double largest_ordinary = 0x1p120;

bool is_extreme(double x) {
  return x != 0 && !(std::abs(x) <= largest_ordinary && std::abs(x) >= 1 / largest_ordinary);
}

template <class Numbers>
bool some_extreme(const Numbers& numbers) {
  return std::any_of(numbers.data(), numbers.data() + numbers.size(), is_extreme);
}

/// Why the numbers are not for doubles to solve with; empty when they are.
std::string_view why_not_in_doubles(const Scene& scene) {
  if (!scene.written && !scene.exact.are_doubles) return "what the rounding of fractions does";
  const convex::NearestPointProblem& problem = scene.problem;
  if (problem.A.kind() == convex::MetricKind::sparse || problem.U.is_sparse()) return {};
  const bool dense = problem.A.kind() == convex::MetricKind::dense;
  const bool extreme = (dense && some_extreme(problem.A.dense_gram())) ||
                       some_extreme(problem.A.diagonal()) || some_extreme(problem.U.dense()) ||
                       some_extreme(problem.z) || some_extreme(problem.s);
  return extreme ? convex::open_question::range : std::string_view();
}

/// A, z, U and s without rounding; none where the text of a mechanism is not rational.
std::optional<convex::ExactProblem> numbers_as_written(const Scene& scene) {
  if (!scene.written) return scene.exact.make();
  return mechanics::fractions_from_text(*scene.written->system, scene.written->text, scene.contacts);
}

/// Whether the answer is now the exact one of the numbers as written.
bool is_decided_by_text(mechanics::GaussSolution& solution, const Scene& scene,
                        const mechanics::GaussOptions& options, std::string_view why) {
  try {
    const auto data = numbers_as_written(scene);
    return data && mechanics::solve_on_exact_data(solution, *data, scene.problem, options, why);
  } catch (const convex::InvalidInput&) {
    // What is said beside the answer, in doubles, has no place for such numbers.
    if (!scene.written && !scene.exact.are_doubles) throw;
    return false;
  }
}

/// Whether rows of a contradiction are not the doubles themselves.
bool rests_on_rounded_rows(const convex::NearestPointProblem& problem,
                           const mechanics::GaussSolution& found) {
  const convex::Vector& w = found.primal.farkas;
  if (found.as_written || !problem.radii || found.primal.status != convex::Status::infeasible ||
      w.size() != problem.rows())
    return false;
  for (convex::Index a = 0; a < w.size(); ++a)
    if (w[a] != 0 && problem.radii->row[a] > 0) return true;
  return false;
}

}  // namespace

mechanics::GaussSolution solve_plainly(const Scene& scene, const mechanics::GaussOptions& options) {
  const bool as_written = static_cast<convex::Index>(scene.contacts.size()) == scene.problem.rows();
  // Rows that were added are not in the text.
  if (!as_written) return mechanics::solve(scene.problem, options);
  bool was_too_long = false;
  if (const std::string_view why = why_not_in_doubles(scene); is_default(options) && !why.empty()) {
    mechanics::GaussSolution exact;
    if (is_decided_by_text(exact, scene, options, why)) return exact;
    was_too_long = exact.was_too_long;
  }
  mechanics::GaussSolution found = mechanics::solve(scene.problem, options);
  found.was_too_long = was_too_long;
  if (!scene.written)  // of a mechanism z is rounded, too, and it is asked where that is known
    mechanics::leave_out_pressing(found.touching, scene.problem, found.primal, found.multipliers,
                                  convex::Vector::Zero(scene.problem.dimension()));
  mechanics::decide_on_exact_data(found, scene.problem, options, [&] { return numbers_as_written(scene); });
  // Rows that other numbers within their radii would not let contradict each other are asked of the text.
  if (is_default(options) && rests_on_rounded_rows(scene.problem, found))
    if (mechanics::GaussSolution exact;
        is_decided_by_text(exact, scene, options, convex::open_question::dependence))
      return exact;
  if (!found.as_written && !scene.written && !scene.exact.are_doubles)
    mechanics::count_rounding_of_data(found, scene.problem, options, scene.exact.make);
  return found;
}

namespace {

/// The dimension of the multipliers.
std::size_t freedom(const convex::Multipliers& multipliers) {
  return multipliers.null_space ? multipliers.null_space->size() : multipliers.unique ? 0 : 1;
}

/// Whether two answers say the same: that there is none, or one acceleration and rows that depend alike.
bool agree(const Scene& scene, const mechanics::GaussSolution& one, const mechanics::GaussSolution& other) {
  if (one.primal.q.size() != other.primal.q.size()) return false;
  if (one.primal.q.size() == 0) return one.primal.status == other.primal.status;
  const double most = scene.solve.accuracy.tolerance * std::max(1.0, other.primal.acceleration_norm);
  return scene.problem.A.norm(one.primal.q - other.primal.q) <= most &&
         freedom(one.multipliers) == freedom(other.multipliers);
}

}  // namespace

mechanics::CertifiedSolution solve_by_fractions(const Scene& scene) {
  mechanics::CertifiedSolution found = mechanics::solve_by_fractions(scene.problem, scene.exact, scene.solve);
  if (!scene.written || !scene.problem.radii) return found;
  mechanics::GaussOptions options = scene.solve;
  options.method = &convex::methods().front();
  mechanics::GaussSolution within = solve_plainly(scene, options);
  if (agree(scene, found.solution, within)) return found;
  found = {};
  found.solution = std::move(within);
  return found;
}

std::vector<mechanics::Warning> resolve_scene(
    Scene& scene, const std::function<const mechanics::GaussSolution&(const Scene&)>& solve) {
  if (!scene.system || scene.problem.two_sided.empty()) {
    solve(scene);
    return {};
  }
  const mechanics::GaussProblem gauss{scene.problem, {scene.contacts, *scene.rates}};
  mechanics::Resolution found =
      mechanics::resolve(*scene.system, scene.state, scene.written->radii, gauss,
                         [&](const convex::NearestPointProblem& problem) -> const mechanics::GaussSolution& {
                           scene.problem = problem;
                           scene.exact.make = [problem] { return convex::exact_problem(problem); };
                           return solve(scene);
                         });
  scene.added = std::move(found.added);
  scene.is_settled = found.is_settled;
  return std::move(found.warnings);
}

std::vector<mechanics::Warning> resolve_for_every_force(Scene& scene) {
  if (!scene.system || scene.problem.two_sided.empty()) return {};
  mechanics::Resolution found = mechanics::resolve_for_every_force(
      *scene.system, scene.state, scene.written->radii, {scene.problem, {scene.contacts, *scene.rates}});
  if (!found.added.empty()) {
    scene.exact.make = [problem = found.problem] { return convex::exact_problem(problem); };
    scene.problem = std::move(found.problem);
    scene.added = std::move(found.added);
    scene.is_settled = found.is_settled;
  }
  return std::move(found.warnings);
}

namespace {

mechanics::CertifiedSolution solve_once(const Scene& scene, bool certify) {
  if (scene.solve.method->name == "exact") return solve_by_fractions(scene);
  // The numbers of a mechanism as evaluated prove nothing of it.
  mechanics::CertifiedSolution found;
  if (certify && !scene.written) {
    found = mechanics::solve_certified(scene.problem, scene.exact, scene.solve);
    if (found.certificate.level != convex::ProofLevel::none) return found;
    // No proof of its own: the answer is the plain one, which fractions may have decided.
    found = {};
  }
  found.solution = solve_plainly(scene, scene.solve);
  if (certify && !scene.written)
    found.certificate = mechanics::plain_certificate(found.solution, scene.exact, scene.solve);
  return found;
}

}  // namespace

std::optional<mechanics::Warning> violated_at_higher_order(const Scene& scene,
                                                           mechanics::GaussSolution& answer) {
  convex::Solution& solution = answer.primal;
  if (!scene.written || solution.status == convex::Status::infeasible ||
      solution.q.size() != scene.problem.dimension())
    return std::nullopt;
  auto warning =
      mechanics::violated_at_higher_order(*scene.written, scene.contacts, scene.added, scene.problem,
                                          answer.multipliers.tight, solution, scene.solve.accuracy);
  if (warning) {
    solution.status = convex::Status::inaccurate;
    solution.error_bound = convex::infinity;
  }
  return warning;
}

namespace {

/// What is not known of the forces.
double force_error(const Scene& scene, const mechanics::GaussSolution& solution) {
  return solution.primal.error_bound +
         mechanics::force_error(*scene.written, scene.contacts, scene.problem, solution);
}

/// Whether the error of the answer leaves open what becomes of a one-sided contact: that it opens, or
/// presses. It is not asked where a text has too many coordinates to decide.
bool leaves_contacts_open(const Scene& scene, const mechanics::GaussSolution& solution) {
  if (scene.problem.dimension() > static_cast<convex::Index>(mechanics::most_exact_coordinates)) return false;
  const convex::Solution& answer = solution.primal;
  // What only touches may press, or be violated, by less than its rounding.
  if (const auto& radii = scene.problem.radii)
    for (const convex::Index a : solution.touching)
      if (radii->s[a] > 0 || radii->row[a] > 0) return true;
  std::vector<convex::Index> rows;
  for (convex::Index a = 0; a < scene.problem.rows(); ++a)
    if (!scene.problem.is_two_sided(a) &&
        !std::binary_search(solution.touching.begin(), solution.touching.end(), a))
      rows.push_back(a);
  const convex::Vector length = convex::dual_lengths(scene.problem, rows);
  const convex::Multipliers& multipliers = solution.multipliers;
  const double of_forces = force_error(scene, solution);
  return std::any_of(rows.begin(), rows.end(), [&](convex::Index a) {
    if (!std::binary_search(multipliers.tight.begin(), multipliers.tight.end(), a))
      return answer.slack[a] <= mechanics::hidden_slack(scene.problem, answer, a, length[a]);
    if (!multipliers.unique && !multipliers.ranges) return false;
    const double most = multipliers.unique ? multipliers.least_norm[a]
                                           : (*multipliers.ranges)[static_cast<std::size_t>(a)].high;
    return most * length[a] <= of_forces;
  });
}

}  // namespace

std::optional<double> settle_evaluation_error(const Scene& scene, mechanics::GaussSolution& solution) {
  if (!scene.written) return std::nullopt;
  const bool was_solved = solution.primal.status == convex::Status::solved;
  const std::optional<double> as_evaluated = count_evaluation_error(scene, solution);
  if (!was_solved || !scene.added.empty()) return as_evaluated;
  const bool is_solved = solution.primal.status == convex::Status::solved;
  if (!is_solved || leaves_contacts_open(scene, solution)) {
    if (is_default(scene.solve) &&
        is_decided_by_text(solution, scene, scene.solve, convex::open_question::conditioning))
      return std::nullopt;
    if (is_solved) mechanics::touch_within_error(solution, scene.problem, force_error(scene, solution));
  }
  if (is_solved) mechanics::accept_where_all_hold(solution, scene.problem);
  return as_evaluated;
}

ProvedScene resolve_and_prove(Scene& scene, bool certify) {
  ProvedScene resolved;
  mechanics::CertifiedSolution& found = resolved.found;
  resolved.warnings = resolve_scene(scene, [&](const Scene& attempt) -> const mechanics::GaussSolution& {
    found = solve_once(attempt, certify);
    return found.solution;
  });
  const auto nothing = [&] {
    found.certificate = {convex::ProofLevel::none, found.solution.primal.error_bound};
  };
  // An added row is known in doubles only: nothing that rests on it is proved of the mechanism.
  if (!scene.added.empty()) nothing();
  if ((certify || scene.solve.method->name == "exact") && scene.written && scene.added.empty())
    mechanics::prove_as_written(found, scene.problem, *scene.written, scene.contacts, scene.solve);
  // What is proved of rows that were settled is proved of the mechanism by its text alone.
  if (scene.is_settled && !(found.text && found.text->error_bound)) nothing();
  if (auto violated = violated_at_higher_order(scene, found.solution)) {
    resolved.warnings.push_back(*std::move(violated));
    nothing();
  }
  if (found.certificate.level == convex::ProofLevel::enclosure && scene.written &&
      found.solution.primal.status == convex::Status::solved) {
    mechanics::leave_out_opening(found.solution, scene.problem, scene.solve.accuracy.tolerance);
    mechanics::touch_within_error(found.solution, scene.problem, force_error(scene, found.solution));
    mechanics::accept_where_all_hold(found.solution, scene.problem);
  }
  return resolved;
}

}  // namespace cli
