#include "mechanics/certified_solution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "mechanics/touching_contacts.hpp"

namespace mechanics {
namespace {

using convex::Certificate;
using convex::ProofLevel;
using convex::Status;

bool small_enough(const convex::NearestPointProblem& problem) {
  return problem.dimension() * (problem.dimension() + problem.rows()) <= most_exact_entries;
}

/// Where fractions take milliseconds they are used for a wide bound too.
bool is_quick(const convex::NearestPointProblem& problem) {
  constexpr Index quick_entries = 40 * 80;
  return problem.dimension() * (problem.dimension() + problem.rows()) <= quick_entries;
}

}  // namespace

bool has_answer(const GaussSolution& solution) {
  return solution.primal.status == Status::solved || solution.primal.status == Status::inaccurate;
}

bool is_default(const GaussOptions& options) {
  return options.method == &convex::methods().front() || options.method->name == "exact";
}

std::vector<Index> touching_in_fractions(const GaussSolution& solution, const ExactGaussSolution& exact) {
  std::vector<Index> found = exact.rounded.touching;
  for (const Index a : solution.multipliers.tight)
    if (convex::sign(exact.primal.slack[static_cast<std::size_t>(a)]) > 0) found.push_back(a);
  std::sort(found.begin(), found.end());
  return found;
}

void judge_by_certificate(CertifiedSolution& found, const GaussOptions& options) {
  convex::Solution& primal = found.solution.primal;
  primal.error_bound = found.certificate.error_bound;
  const bool close =
      primal.error_bound <= options.accuracy.tolerance * std::max(1.0, primal.acceleration_norm);
  primal.status = close && std::isfinite(primal.error_bound) ? Status::solved : Status::inaccurate;
}

Certificate plain_certificate(const GaussSolution& solution, const ExactData& data,
                              const GaussOptions& options) {
  const convex::Solution& primal = solution.primal;
  const convex::Model& model = primal.model;
  const bool is_whole = is_default(options) && model.islands.size() == 1 && model.left_out.empty() &&
                        !model.islands.front().in_fractions.empty();
  const bool is_exact = solution.as_written || (data.are_doubles && is_whole);
  const bool is_ended = primal.status == Status::solved || primal.status == Status::infeasible;
  return {is_exact && is_ended ? ProofLevel::exact : ProofLevel::none, primal.error_bound};
}

namespace {

CertifiedSolution solve_by_fractions(const convex::NearestPointProblem& problem, const ExactData& data,
                                     const GaussOptions& options, double most_words) {
  if (const std::string reason = options.method->applies(problem); !reason.empty())
    throw convex::InvalidInput("method \"" + std::string(options.method->name) + "\": " + reason);
  CertifiedSolution found;
  found.exact = solve_exactly(data.make(), problem, options, {}, most_words);
  found.solution = found.exact->rounded;
  if (found.solution.primal.status == Status::gave_up) return found;
  const bool infeasible = found.solution.primal.status == Status::infeasible;
  found.certificate = {ProofLevel::exact, infeasible ? 0 : found.solution.primal.error_bound};
  return found;
}

}  // namespace

CertifiedSolution solve_by_fractions(const convex::NearestPointProblem& problem, const ExactData& data,
                                     const GaussOptions& options) {
  return solve_by_fractions(problem, data, options, std::numeric_limits<double>::infinity());
}

CertifiedSolution solve_certified(const convex::NearestPointProblem& problem, const ExactData& data,
                                  const GaussOptions& options) {
  const double most_words = options.accuracy.limit * convex::most_word_operations;
  CertifiedSolution found;
  try {
    found.solution = solve(problem, options);
  } catch (const convex::InvalidInput&) {  // in no units do doubles hold these numbers
    return solve_by_fractions(problem, data, options, most_words);
  }
  std::optional<double> bound;
  if (data.are_doubles && has_answer(found.solution))
    bound = convex::enclosed_error(problem, found.solution.primal);
  const auto enclosed = [&] {
    found.certificate = {ProofLevel::enclosure, *bound};
    judge_by_certificate(found, options);
    return found;
  };
  const double norm = found.solution.primal.acceleration_norm;
  const double wanted =
      is_quick(problem) ? few_ulps * norm : options.accuracy.tolerance * std::max(1.0, norm);
  // What doubles leave open of the multipliers is told by fractions.
  leave_out_pressing(found.solution.touching, problem, found.solution.primal, found.solution.multipliers,
                     Vector::Zero(problem.dimension()));
  const bool is_open = !open_question_of(problem, found.solution).empty() ||
                       may_press(found.solution.touching, problem, found.solution.multipliers);
  if (bound && *bound <= wanted && !(is_open && small_enough(problem))) return enclosed();
  if (data.are_doubles && !is_quick(problem) && found.solution.primal.status == Status::infeasible)
    if (auto proof = convex::infeasibility_proof(problem, found.solution.primal.farkas)) {
      found.certificate = {proof->level, 0};
      found.solution.primal.farkas = std::move(proof->farkas);
      found.farkas = std::move(proof->weights);
      return found;
    }
  if (!small_enough(problem)) return bound ? enclosed() : found;
  CertifiedSolution exact = solve_by_fractions(problem, data, options, most_words);
  const bool gave_up = exact.solution.primal.status == Status::gave_up, is_whole = exact.exact->is_whole;
  const bool has_both = has_answer(found.solution) && has_answer(exact.solution);
  if (!gave_up && is_whole && (is_default(options) || !has_both)) return exact;
  // What fractions would tell of the multipliers takes too long.
  if (std::string_view open = open_question_of(problem, found.solution); gave_up || !is_whole)
    found.solution.primal.undecided = open.empty() ? convex::open_question::dependence : open;
  if (gave_up || !has_both) return bound ? enclosed() : found;
  found.certificate = {ProofLevel::exact,
                       convex::distance_above(data.make(), found.solution.primal.q, exact.exact->primal.q)};
  judge_by_certificate(found, options);
  return found;
}

}  // namespace mechanics
