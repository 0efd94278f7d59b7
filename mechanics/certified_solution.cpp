#include "mechanics/certified_solution.hpp"

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"

namespace mechanics {
namespace {

using convex::Certificate;
using convex::ProofLevel;
using convex::Status;

bool small_enough(const convex::NearestPointProblem& problem) {
  return problem.dimension() * (problem.dimension() + problem.rows()) <= most_exact_entries;
}

/// A bound on doubles cannot be expected to be better than this part of ||q||_A.
constexpr double few_ulps = 4 * 0x1p-52;

/// Where fractions take milliseconds they are used for a wide bound too.
bool is_quick(const convex::NearestPointProblem& problem) {
  constexpr Index quick_entries = 40 * 80;
  return problem.dimension() * (problem.dimension() + problem.rows()) <= quick_entries;
}

/// Whether the caller left the method to the program.
bool is_default(const GaussOptions& options) {
  return options.method == &convex::methods().front() || options.method->name == "exact";
}

/// The status that a proved bound gives.
void judge(CertifiedSolution& found, const GaussOptions& options) {
  convex::Solution& primal = found.solution.primal;
  primal.error_bound = found.certificate.error_bound;
  const bool close =
      primal.error_bound <= options.accuracy.tolerance * std::max(1.0, primal.acceleration_norm);
  primal.status = close ? Status::solved : Status::inaccurate;
}

bool has_answer(const GaussSolution& solution) {
  return solution.primal.status == Status::solved || solution.primal.status == Status::inaccurate;
}

}  // namespace

CertifiedSolution solve_by_fractions(const convex::NearestPointProblem& problem, const ExactData& data,
                                     const GaussOptions& options) {
  if (const std::string reason = options.method->applies(problem); !reason.empty())
    throw convex::InvalidInput("method \"" + std::string(options.method->name) + "\": " + reason);
  CertifiedSolution found;
  found.exact = solve_exactly(data.make(), problem, options);
  found.solution = found.exact->rounded;
  const bool infeasible = found.solution.primal.status == Status::infeasible;
  found.certificate = {ProofLevel::exact, infeasible ? 0 : found.solution.primal.error_bound};
  return found;
}

void prove_from_text(CertifiedSolution& found, const convex::NearestPointProblem& problem,
                     const ExactTextProblem& text, const GaussOptions& options) {
  found.text = TextProof{solve_exactly(text.problem, problem, options), text.contacts_hold, 0};
  const GaussSolution& exact = found.text->exact.rounded;
  if (has_answer(exact) != has_answer(found.solution)) {
    found.solution = exact;
    found.exact.reset();
    found.certificate = {ProofLevel::exact, has_answer(exact) ? exact.primal.error_bound : 0};
    found.text->error_bound = found.certificate.error_bound;
    return;
  }
  if (!has_answer(exact)) return;
  found.text->error_bound =
      convex::distance_above(text.problem, found.solution.primal.q, found.text->exact.primal.q);
  if (found.certificate.level == ProofLevel::none) found.certificate = {ProofLevel::exact, 0};
  found.certificate.error_bound = std::max(found.certificate.error_bound, found.text->error_bound);
  judge(found, options);
}

CertifiedSolution solve_certified(const convex::NearestPointProblem& problem, const ExactData& data,
                                  const GaussOptions& options) {
  CertifiedSolution found;
  found.solution = solve(problem, options);
  if (data.are_doubles && has_answer(found.solution))
    if (const auto bound = convex::enclosed_error(problem, found.solution.primal);
        bound && (!is_quick(problem) || *bound <= few_ulps * found.solution.primal.acceleration_norm)) {
      found.certificate = {ProofLevel::enclosure, *bound};
      judge(found, options);
      return found;
    }
  if (!small_enough(problem)) return found;
  CertifiedSolution exact = solve_by_fractions(problem, data, options);
  if (is_default(options) || !has_answer(found.solution) || !has_answer(exact.solution)) return exact;
  found.certificate = {ProofLevel::exact,
                       convex::distance_above(data.make(), found.solution.primal.q, exact.exact->primal.q)};
  judge(found, options);
  return found;
}

}  // namespace mechanics
