#include "mechanics/exact_gauss_solution.hpp"

#include <algorithm>

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

}  // namespace

ExactGaussSolution solve_exactly(const convex::ExactProblem& exact,
                                 const convex::NearestPointProblem& problem, const GaussOptions& options) {
  ExactGaussSolution found;
  found.primal = convex::exact_active_set(exact, guess(problem));
  GaussSolution& rounded = found.rounded;
  rounded.primal = convex::rounded(exact, found.primal, options.accuracy);
  if (found.primal.status == convex::Status::infeasible) return found;

  const bool ranges = options.always_ranges || problem.rows() <= most_ranges;
  found.multipliers = convex::exact_multipliers(exact, found.primal, ranges);
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
  rounded.hypothesis = exact_hypothesis(exact, found.primal);
  if (problem.rows() <= most_contacts_from_dual && fit_units(problem).ordinary())
    rounded.from_dual = reaction_from_dual(problem, rounded.hypothesis.two_sided, rounded.primal);
  return found;
}

namespace {

/// Whether the method had to ask fractions for the answer.
bool is_decided_in_fractions(const convex::Solution& primal) {
  const auto& islands = primal.model.islands;
  return std::any_of(islands.begin(), islands.end(),
                     [](const convex::Island& island) { return !island.in_fractions.empty(); });
}

/// Whether doubles may not know which rows depend on each other: where they count some as dependent that are
/// independent as they stand, or may be within their radii, or could not tell the active ones.
bool may_be_independent(const convex::NearestPointProblem& problem, const GaussSolution& solution) {
  const convex::Multipliers& found = solution.multipliers;
  if (!problem.radii)
    return found.is_in_doubt || solution.hypothesis.two_sided.is_in_doubt ||
           is_decided_in_fractions(solution.primal);
  if (found.least_norm.size() != problem.rows() || found.unique) return false;
  const auto is_rounded = [&](Index row) { return problem.radii->row[row] > 0 || problem.radii->s[row] > 0; };
  if (!found.null_space) return true;
  for (const convex::NullVector& weights : *found.null_space)
    for (const auto& [row, weight] : weights)
      if (is_rounded(row)) return true;
  return false;
}

}  // namespace

bool solve_on_exact_data(GaussSolution& found, const convex::ExactProblem& exact,
                         const convex::NearestPointProblem& problem, const GaussOptions& options,
                         std::string_view open) {
  const auto held = static_cast<std::size_t>(std::min(problem.rows(), problem.dimension()));
  if (convex::word_operations(exact, held) > options.accuracy.limit * convex::most_word_operations)
    return false;
  ExactGaussSolution decided = solve_exactly(exact, problem, options);
  convex::Solution& answer = decided.rounded.primal;
  answer.method = "active-set";
  const Index n = problem.dimension();
  answer.model.islands = {{answer.method, n, problem.rows(), 0, decided.primal.word_operations,
                           static_cast<double>(n * n) / 2, open}};
  found = std::move(decided.rounded);
  found.as_written = true;
  return true;
}

void decide_on_exact_data(GaussSolution& found, const convex::NearestPointProblem& problem,
                          const GaussOptions& options,
                          const std::function<std::optional<convex::ExactProblem>()>& data) {
  const convex::Solution& primal = found.primal;
  const bool ended = primal.status == convex::Status::solved || primal.status == convex::Status::infeasible;
  const bool is_default = options.method == &convex::methods().front();
  const bool is_doubtful = may_be_independent(problem, found);
  // What rounding alone left open in numbers that are exact, the method has asked fractions already.
  if (!is_doubtful && (!problem.radii || (ended && primal.undecided.empty()))) return;
  const std::string_view open = is_doubtful                 ? convex::open_question::dependence
                                : !primal.undecided.empty() ? primal.undecided
                                                            : convex::open_question::conditioning;
  // Sizes alone may tell that it is too much, before any number is converted.
  const double n = static_cast<double>(problem.dimension());
  if (is_default && n * n * n <= options.accuracy.limit * convex::most_word_operations)
    if (const std::optional<convex::ExactProblem> exact = data())
      solve_on_exact_data(found, *exact, problem, options, open);
  if (!found.as_written) found.primal.undecided = open;
}

}  // namespace mechanics
