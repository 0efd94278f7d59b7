#include "mechanics/exact_gauss_solution.hpp"

#include <algorithm>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "mechanics/touching_contacts.hpp"
#include "mechanics/units.hpp"

namespace mechanics {
namespace {

/// Rows that doubles take for active; none where the numbers are beyond what doubles can solve with.
std::vector<Index> guess(const convex::NearestPointProblem& problem) {
  try {
    return convex::likely_active_rows(in_units(problem, fit_units(problem)));
  } catch (const convex::InvalidInput&) {
    return {};
  }
}

/// The exact numbers, each rounded once, where `problem` has them with radii; null where they are no ordinary
/// doubles.
std::shared_ptr<const convex::NearestPointProblem> rounded_once(const convex::ExactProblem& exact,
                                                                const convex::NearestPointProblem& problem) {
  if (!problem.radii) return nullptr;
  try {
    auto data = std::make_shared<convex::NearestPointProblem>(convex::rounded(exact));
    data->radii = convex::rounding_radii(*data, 1);
    return data;
  } catch (const convex::InvalidInput&) {
    return nullptr;
  }
}

}  // namespace

ExactGaussSolution solve_exactly(const convex::ExactProblem& exact,
                                 const convex::NearestPointProblem& evaluated, const GaussOptions& options,
                                 const std::vector<Index>& rows, double most_words) {
  ExactGaussSolution found;
  found.primal = convex::exact_active_set(exact, rows.empty() ? guess(evaluated) : rows, most_words);
  GaussSolution& rounded = found.rounded;
  rounded.primal.status = found.primal.status;
  if (found.primal.status == convex::Status::gave_up) return found;
  rounded.primal = convex::rounded(exact, found.primal, options.accuracy);
  if (found.primal.status == convex::Status::infeasible) return found;

  rounded.data = rounded_once(exact, evaluated);
  const convex::NearestPointProblem& problem = rounded.data ? *rounded.data : evaluated;
  const bool ranges = options.always_ranges || problem.rows() <= most_ranges;
  const double left = most_words - found.primal.word_operations;
  std::optional<convex::ExactMultipliers> multipliers =
      convex::exact_multipliers(exact, found.primal, ranges, left);
  std::optional<Hypothesis> hypothesis;
  if (multipliers) hypothesis = exact_hypothesis(exact, found.primal, left);
  found.is_whole = hypothesis.has_value();
  if (!found.is_whole) return found;
  found.multipliers = *std::move(multipliers);
  found.reaction = convex::reaction(exact, found.multipliers.least_norm);
  // G = ½ q·Aq - z·q.
  const convex::Fraction energy = convex::squared_norm(exact, found.primal.q);
  found.gauss = energy / convex::Fraction{2, 1} -
                convex::lowest_terms(convex::dot(convex::ExactVector{exact.z, exact.unit}, found.primal.q));

  rounded.multipliers = convex::rounded(found.multipliers);
  rounded.touching = touching_contacts(problem, rounded.primal, rounded.multipliers, 0);
  rounded.reaction = convex::nearest(found.reaction);
  rounded.gauss = convex::nearest_double(found.gauss);
  rounded.primal.force_norm = problem.A.dual_norm(problem.z);
  rounded.residuals = rounded.primal.residuals =
      convex::residuals(problem, rounded.primal.q, rounded.multipliers.least_norm);
  rounded.hypothesis = *std::move(hypothesis);
  if (problem.rows() <= most_contacts_from_dual && fit_units(problem).ordinary())
    rounded.from_dual = reaction_from_dual(problem, rounded.hypothesis.two_sided, rounded.primal);
  return found;
}

bool is_decided_in_fractions(const convex::Solution& primal) {
  const auto& islands = primal.model.islands;
  return std::any_of(islands.begin(), islands.end(),
                     [](const convex::Island& island) { return !island.in_fractions.empty(); });
}

namespace {

/// The rows of an answer that fractions gave: of the doubles of the data, if not of the data themselves.
std::vector<Index> rows_decided(const convex::Solution& primal) {
  if (!is_decided_in_fractions(primal)) return {};
  std::vector<Index> rows = primal.basis;
  for (Index a = 0; a < primal.farkas.size(); ++a)
    if (primal.farkas[a] != 0) rows.push_back(a);
  return rows;
}

/// Nothing is known of the error of an answer that is another one than that of fractions, or none is.
void refute(convex::Solution& primal, std::string_view open) {
  primal.undecided = open;
  primal.error_bound = convex::infinity;
  if (primal.status == convex::Status::solved) primal.status = convex::Status::inaccurate;
}

/// What is open of numbers that are exact may be of the acceleration too: it is solved where that is proved,
/// in doubles or by the acceleration alone in fractions.
void judge_open_answer(convex::Solution& primal, const convex::NearestPointProblem& problem,
                       const std::optional<convex::ExactProblem>& exact, const convex::Accuracy& accuracy) {
  if (problem.radii || primal.status != convex::Status::solved || is_decided_in_fractions(primal)) return;
  double bound = convex::bound_proved_in_doubles(problem, primal, accuracy);
  if (exact && !(bound <= accuracy.tolerance * std::max(1.0, primal.acceleration_norm)))
    bound = std::min(bound, convex::bound_proved_in_fractions(*exact, primal, accuracy));
  primal.error_bound = std::max(primal.error_bound, bound);
  if (!primal.is_within(accuracy)) primal.status = convex::Status::inaccurate;
}

/// Whether rows count as dependent on each other that may be independent within their radii.
bool depend_within_radii(const convex::NearestPointProblem& problem, const convex::Multipliers& found) {
  if (found.least_norm.size() != problem.rows() || found.unique) return false;
  const auto is_rounded = [&](Index row) { return problem.radii->row[row] > 0 || problem.radii->s[row] > 0; };
  if (!found.null_space) return true;
  for (const convex::NullVector& weights : *found.null_space)
    for (const auto& [row, weight] : weights)
      if (is_rounded(row)) return true;
  return false;
}

/// Of all ranges.
double words_of_ranges(const convex::Multipliers& found) {
  return found.null_space ? convex::words_of_ranges(found.tight.size(), found.null_space->size()) : 0;
}

/// What holds of the multipliers and the hypothesis, whichever method found q: from fractions, beside its own
/// q.
void judge_in_fractions(GaussSolution& found, const std::optional<convex::ExactProblem>& exact,
                        const convex::NearestPointProblem& problem, const GaussOptions& options,
                        std::string_view open) {
  GaussSolution truth = found;
  if (!solve_on_exact_data(truth, *exact, problem, options, open)) {
    found.primal.undecided = open;
    judge_open_answer(found.primal, problem, exact, options.accuracy);
    return;
  }
  const convex::Solution& answer = truth.primal;
  const double near = options.accuracy.tolerance * std::max(1.0, found.primal.acceleration_norm);
  if (answer.status == convex::Status::infeasible || !(problem.A.norm(answer.q - found.primal.q) <= near)) {
    refute(found.primal, open);
    return;
  }
  found.multipliers = std::move(truth.multipliers);
  found.touching = std::move(truth.touching);
  found.hypothesis = std::move(truth.hypothesis);
  found.reaction = std::move(truth.reaction);
  found.from_dual = std::move(truth.from_dual);
  found.primal.model = std::move(truth.primal.model);
  found.primal.undecided = {};
  found.residuals = convex::residuals(problem, found.primal.q, found.multipliers.least_norm);
}

}  // namespace

std::string_view open_question_of(const convex::NearestPointProblem& problem, const GaussSolution& solution) {
  const convex::Solution& primal = solution.primal;
  const convex::Multipliers& multipliers = solution.multipliers;
  if (multipliers.is_in_doubt || solution.hypothesis.two_sided.is_in_doubt)
    return convex::open_question::dependence;
  // What doubles left open of q in numbers that are exact, the method has asked fractions already; the rest
  // then needs them too.
  if (!problem.radii)
    return is_decided_in_fractions(primal) ? convex::open_question::dependence : std::string_view();
  if (depend_within_radii(problem, multipliers)) return convex::open_question::dependence;
  if (!primal.undecided.empty()) return primal.undecided;
  const bool ended = primal.status == convex::Status::solved || primal.status == convex::Status::infeasible;
  return ended ? std::string_view() : convex::open_question::conditioning;
}

bool is_at_rounding(const convex::Solution& primal) {
  constexpr double roundings = 64;  // of what it is computed from, and of the digits that it is given in
  const double scale = std::max(primal.acceleration_norm, primal.force_norm);
  return primal.error_bound <= roundings * convex::unit_roundoff * scale;
}

bool solve_on_exact_data(GaussSolution& found, const convex::ExactProblem& exact,
                         const convex::NearestPointProblem& problem, const GaussOptions& options,
                         std::string_view open) {
  const auto held = static_cast<std::size_t>(std::min(problem.rows(), problem.dimension()));
  const double of_ranges = words_of_ranges(found.multipliers),
               most = options.accuracy.limit * convex::most_word_operations - of_ranges;
  if (convex::word_operations(exact, held) > most) return false;
  ExactGaussSolution decided = solve_exactly(exact, problem, options, rows_decided(found.primal), most);
  found.was_too_long = decided.primal.status == convex::Status::gave_up || !decided.is_whole;
  if (found.was_too_long) return false;
  convex::Solution& answer = decided.rounded.primal;
  answer.method = "active-set";
  answer.model = std::move(found.primal.model);
  const Index n = problem.dimension();
  if (answer.model.islands.empty())
    answer.model.islands = {{answer.method, n, problem.rows(), 0, decided.primal.word_operations,
                             static_cast<double>(n * n) / 2, open}};
  for (convex::Island& island : answer.model.islands)
    if (island.in_fractions.empty()) island.in_fractions = open;
  decided.rounded.reduced = std::move(found.reduced);
  found = std::move(decided.rounded);
  found.as_written = true;
  return true;
}

void decide_on_exact_data(GaussSolution& found, const convex::NearestPointProblem& problem,
                          const GaussOptions& options,
                          const std::function<std::optional<convex::ExactProblem>()>& data) {
  const bool is_named = options.method != &convex::methods().front();
  std::string_view open = open_question_of(problem, found);
  if (open.empty() && !is_named && !problem.radii && may_press(found.touching, problem, found.multipliers))
    open = convex::open_question::dependence;
  if (open.empty()) return;
  const double most_words = options.accuracy.limit * convex::most_word_operations,
               n = static_cast<double>(problem.dimension());
  const bool is_solved = found.primal.status == convex::Status::solved;
  // Sizes alone may tell that it is too much, before any number is converted.
  std::optional<convex::ExactProblem> exact;
  if ((!is_named || is_solved) && n * n * n <= most_words) exact = data();
  if (exact && is_named) return judge_in_fractions(found, exact, problem, options, open);
  // What fractions could not do with the doubles they are not asked again for numbers that are as long.
  const auto held = static_cast<std::size_t>(std::min(problem.rows(), problem.dimension()));
  const bool was_too_long = !problem.radii && !is_solved && !found.primal.undecided.empty();
  const bool is_known = found.was_too_long && rows_decided(found.primal).empty();
  if (exact && !is_known &&
      !(was_too_long && 2 * convex::word_operations(*exact, held) >
                            convex::word_operations(convex::exact_problem(problem), held)))
    solve_on_exact_data(found, *exact, problem, options, open);
  if (found.as_written) return;
  // Where the answer is at rounding it is the tolerance that is too small.
  const bool is_open = open != convex::open_question::conditioning || !is_at_rounding(found.primal);
  found.primal.undecided = is_open ? open : std::string_view();
  if (is_open) judge_open_answer(found.primal, problem, exact, options.accuracy);
}

}  // namespace mechanics
