#include "mechanics/certified_solution.hpp"

#include <algorithm>

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

/// Whether the constraints of K touch, and no other one does.
bool prove_all(const std::vector<ContactVerdict>& verdicts, const std::vector<Index>& contacts) {
  for (std::size_t a = 0; a < verdicts.size(); ++a) {
    const bool in_K = std::binary_search(contacts.begin(), contacts.end(), static_cast<Index>(a));
    if (verdicts[a] != (in_K ? ContactVerdict::touches : ContactVerdict::apart)) return false;
  }
  return true;
}

bool has_answer(const GaussSolution& solution) {
  return solution.primal.status == Status::solved || solution.primal.status == Status::inaccurate;
}

std::vector<Index> likely_rows(const CertifiedSolution& found, const convex::NearestPointProblem& problem) {
  return has_answer(found.solution) && !found.solution.primal.basis.empty()
             ? found.solution.primal.basis
             : convex::likely_active_rows(problem);
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
                     const TextProblem& text, const std::vector<Index>& contacts,
                     const GaussOptions& options) {
  TextProof& proof = found.text.emplace();
  proof.contacts = text.contacts;
  proof.contacts_hold = prove_all(text.contacts, contacts);
  const convex::ExactProblem& middle = text.problem.middle;
  if (text.is_exact) {
    proof.exact = solve_exactly(middle, problem, options);
  } else {
    proof.enclosed = convex::enclosed_solution(text.problem, likely_rows(found, problem));
    if (!proof.enclosed) return;
  }
  const bool feasible =
      proof.exact ? has_answer(proof.exact->rounded) : proof.enclosed->status != Status::infeasible;
  const ProofLevel level = proof.exact ? ProofLevel::exact : ProofLevel::enclosure;
  if (feasible != has_answer(found.solution)) {
    found.solution = proof.exact ? proof.exact->rounded : solve_exactly(middle, problem, options).rounded;
    found.exact.reset();
    found.certificate = {level, 0};
  }
  if (found.certificate.level == ProofLevel::none) found.certificate = {level, 0};
  if (!feasible) {
    proof.error_bound = 0;
    return;
  }
  const Vector& q = found.solution.primal.q;
  proof.error_bound = proof.exact ? convex::distance_above(middle, q, proof.exact->primal.q)
                                  : convex::distance_above(text.problem, *proof.enclosed, q);
  if (proof.enclosed) {
    constexpr int digits = 30;
    proof.acceleration = convex::decimals(text.problem, *proof.enclosed, digits);
    found.certificate.level = ProofLevel::enclosure;
  }
  found.certificate.error_bound = std::max(found.certificate.error_bound, *proof.error_bound);
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
  if (data.are_doubles && !is_quick(problem) && found.solution.primal.status == Status::infeasible)
    if (auto proof = convex::infeasibility_proof(problem, found.solution.primal.farkas)) {
      found.certificate = {proof->level, 0};
      found.solution.primal.farkas = std::move(proof->farkas);
      found.farkas = std::move(proof->weights);
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
