#include "convex/nearest_point/proof/decided_in_fractions.hpp"

#include <algorithm>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "convex/nearest_point/proof/infeasibility_proof.hpp"
#include "convex/nearest_point/working_set/dependent_row.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline proof {
namespace {

std::vector<Index> rows_of(const NearestPointProblem& problem, const Solution& open) {
  std::vector<Index> rows = problem.two_sided;
  const auto add = [&](Index a) {
    if (std::find(rows.begin(), rows.end(), a) == rows.end()) rows.push_back(a);
  };
  for (Index a : open.basis) add(a);
  if (open.basis.empty() && open.lambda.size() == problem.rows())
    for (Index a = 0; a < problem.rows(); ++a)
      if (open.lambda[a] > 0) add(a);
  if (open.farkas.size() == problem.rows())
    for (Index a = 0; a < problem.rows(); ++a)
      if (open.farkas[a] > 0) add(a);
  return rows;
}

/// Of the word operations that fractions may take, what they may for signs within the error bound.
constexpr double part_for_zeros = 0.2;

/// The solution in fractions, rounded; none where that takes too many word operations.
std::optional<Solution> in_fractions(const NearestPointProblem& problem, const Solution& open,
                                     const Accuracy& accuracy, double most, std::string_view why) {
  // Sizes alone may tell that it is too much, before any number is converted.
  const double n = static_cast<double>(problem.dimension());
  if (n * n * n > most) return std::nullopt;
  const ExactProblem exact = exact_problem(problem);
  const ExactSolution found = exact_active_set(exact, rows_of(problem, open), most);
  if (found.status == Status::gave_up) return std::nullopt;
  Solution solution = rounded(exact, found, accuracy);
  solution.method = open.method;
  solution.steps += open.steps;
  solution.force_norm = problem.A.dual_norm(problem.z);
  if (found.status != Status::infeasible)
    solution.residuals = residuals(problem, solution.q, solution.lambda);
  solution.model.islands = {
      {open.method, problem.dimension(), problem.rows(), 0, found.word_operations, n * n / 2, why}};
  return solution;
}

/// A contradiction of few rows: of one that lies in the span of the working set, as far as doubles tell, with
/// those that it is made of. Nothing else is looked at, so that it takes as long as these are many. None
/// where no such row contradicts the others, or the problem is too large for a dense factor.
std::optional<Solution> contradiction_of_few_rows(const NearestPointProblem& problem, const Solution& open) {
  constexpr Index few = 32;  // beyond, the proof would not be quick
  if (!is_dense_size(problem) || open.slack.size() != problem.rows()) return std::nullopt;
  WorkingSet set(problem);
  WorkingSet::Split split;
  for (Index a : open.basis) {
    set.split(a, split);
    if (split.rho > 0) set.append(a, split, 0);
  }
  const Vector magnitude = open.q.cwiseAbs();
  for (Index p = 0; p < problem.rows(); ++p) {
    const double terms = std::abs(problem.s[p]) + problem.U.absolute_dot(p, magnitude);
    if (set.holds(p) || !(open.slack[p] <= near_zero * terms)) continue;
    set.split(p, split);
    if (split.rho > 0) continue;
    for (const double sign : {1.0, -1.0}) {
      if (sign < 0 && !problem.is_two_sided(p)) continue;
      const Vector weights = contradiction_weights(set, p, split, sign);
      if ((weights.array() != 0).count() > few ||
          std::any_of(set.rows().begin(), set.rows().end(),
                      [&](Index a) { return weights[a] < 0 && !problem.is_two_sided(a); }))
        continue;
      if (const auto proof = infeasibility_proof(problem, weights)) {
        Solution found;
        found.status = Status::infeasible;
        found.method = open.method;
        found.steps = open.steps;
        found.force_norm = open.force_norm;
        found.farkas = proof->farkas;
        found.model.islands = {
            {open.method, problem.dimension(), problem.rows(), 0, 0, 0, open_question::contradiction}};
        return found;
      }
    }
  }
  return std::nullopt;
}

Solution left_open(Solution open) {
  if (open.undecided == open_question::zero_slacks) {
    open.undecided = {};
    return open;
  }
  if (open.status == Status::solved) open.status = Status::inaccurate;
  if (open.status == Status::infeasible) open.status = Status::gave_up;
  return open;
}

}  // namespace

Solution decided_in_fractions(const NearestPointProblem& problem, Solution open, const Accuracy& accuracy) {
  if (open.undecided.empty() || problem.radii) return open;
  // Asked for more than doubles can hold: fractions, rounded, would be no better.
  constexpr double few_ulps = 4 * unit_roundoff;
  if (open.undecided == open_question::conditioning &&
      open.error_bound <= few_ulps * open.acceleration_norm && open.status == Status::inaccurate)
    return open;
  const bool is_within_bound = open.undecided == open_question::zero_slacks;
  std::optional<Solution> found = in_fractions(
      problem, open, accuracy, (is_within_bound ? part_for_zeros : 1) * accuracy.limit * most_word_operations,
      open.undecided);
  if (!found && !is_within_bound && accuracy.limit > 0) found = contradiction_of_few_rows(problem, open);
  return found ? *std::move(found) : left_open(std::move(open));
}

double bound_proved_in_doubles(const NearestPointProblem& problem, const Solution& found,
                               const Accuracy& accuracy) {
  const double by_gap = bound_by_gap(problem, found);
  if (by_gap <= accuracy.tolerance * std::max(1.0, found.acceleration_norm)) return by_gap;
  return std::min(by_gap, enclosed_error(problem, found).value_or(infinity));
}

double bound_proved_in_fractions(const ExactProblem& exact, const Solution& found, const Accuracy& accuracy) {
  // Many rows may carry the multipliers of the answer; those of a vertex need no exchange.
  std::vector<Index> guess;
  try {
    guess = likely_active_rows(rounded(exact));
  } catch (const InvalidInput&) {  // doubles are too coarse for the data
  }
  const ExactSolution truth = exact_active_set(exact, guess, accuracy.limit * most_word_operations);
  return truth.status == Status::solved ? distance_above(exact, found.q, truth.q) : infinity;
}

Solution bounded_where_decided(const NearestPointProblem& problem, Solution found, const Accuracy& accuracy) {
  const bool is_open =
      found.undecided == open_question::dependence || found.undecided == open_question::contradiction;
  if (!is_open || problem.radii || found.status != Status::inaccurate) return found;
  found.error_bound = infinity;
  if (!(accuracy.limit > 0) || found.q.size() != problem.dimension()) return found;
  found.error_bound = bound_proved_in_doubles(problem, found, accuracy);
  if (!found.is_within(accuracy)) return found;
  found.status = Status::solved;
  found.undecided = {};
  return found;
}

bool has_open_zeros(const NearestPointProblem& problem, const Solution& solved) {
  if (solved.status != Status::solved || problem.radii) return false;
  if (std::none_of(solved.basis.begin(), solved.basis.end(),
                   [&](Index a) { return solved.lambda[a] == 0 && !problem.is_two_sided(a); }))
    return false;
  std::vector<bool> told(at(problem.rows()), false);  // without a sign to tell
  for (Index a : problem.two_sided) told[at(a)] = true;
  for (Index a : solved.basis) told[at(a)] = true;
  std::vector<Index> degenerate;
  for (Index a = 0; a < problem.rows(); ++a)
    if (!told[at(a)] && solved.slack[a] == 0) degenerate.push_back(a);
  // The point of the working set itself, and in balance with its multipliers, or a vertex.
  const bool is_vertex = static_cast<Index>(solved.basis.size()) == problem.dimension();
  return !slacks_if_kept(problem, solved.q, solved.basis, degenerate) ||
         !(is_vertex || is_in_balance(problem, solved.q, DoubleDoubleVector(solved.lambda)));
}

Solution with_signs_of_zeros(const NearestPointProblem& problem, Solution solved, const Accuracy& accuracy) {
  std::optional<Solution> found =
      in_fractions(problem, solved, accuracy, part_for_zeros * accuracy.limit * most_word_operations,
                   open_question::degenerate_rows);
  return found ? *std::move(found) : solved;
}

Solution with_open_signs(const NearestPointProblem& problem, Solution&& solved, const Accuracy& accuracy) {
  if (!has_open_zeros(problem, solved)) return std::move(solved);
  return with_signs_of_zeros(problem, std::move(solved), accuracy);
}

}  // namespace convex::inline proof
