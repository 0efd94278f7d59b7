#include "mechanics/gauss_solution.hpp"

#include <cmath>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "mechanics/touching_contacts.hpp"
#include "mechanics/units.hpp"
#include "mechanics/vertex.hpp"

namespace mechanics {
namespace {

/// Numbers within this of their scale count as zero where persistence and signs are judged, unless the caller
/// asks for a tighter answer.
double zero_tolerance(const convex::Accuracy& accuracy) { return std::min(accuracy.tolerance, 1e-6); }

/// R by entry from A q'' - z or from Σ lambda_a u_a, whichever rounding hurts less: the one where forces
/// between bodies cancel, the other where nothing pushes.
Vector reaction(const convex::NearestPointProblem& problem, const Vector& q, const Vector& lambda) {
  const Vector inertial = problem.A.multiply(q) - problem.z, applied = problem.U.transpose_times(lambda);
  Vector applied_terms = Vector::Zero(q.size());
  for (Index a = 0; a < problem.rows(); ++a) {
    if (lambda[a] == 0) continue;
    if (problem.U.is_sparse())
      for (convex::SparseRows::InnerIterator it(problem.U.sparse(), a); it; ++it)
        applied_terms[it.col()] += std::abs(it.value() * lambda[a]);
    else
      applied_terms += problem.U.dense().row(a).transpose().cwiseAbs() * std::abs(lambda[a]);
  }
  const Vector weight = problem.A.diagonal().cwiseSqrt();
  const double motion = q.cwiseAbs().dot(weight);  // |a_ik| <= sqrt(a_ii a_kk)
  Vector R(q.size());
  for (Index i = 0; i < q.size(); ++i)
    R[i] = applied_terms[i] <= weight[i] * motion + std::abs(problem.z[i]) ? applied[i] : inertial[i];
  return R;
}

Reduced reduced(const convex::NearestPointProblem& problem, const convex::Solution& whole,
                convex::Accuracy accuracy) {
  accuracy.reduce = true;
  convex::Solution parts = convex::automatic(problem, accuracy);
  Reduced found{std::move(parts.model), 0};
  const double scale = std::max(whole.acceleration_norm, whole.force_norm);
  if (parts.q.size() == whole.q.size() && scale > 0)
    found.difference = problem.A.norm(parts.q - whole.q) / scale;
  return found;
}

/// By section 5's cone at x_0: the two-sided solution, or, where the contacts contradict each other as
/// equations only because of redundant ones, the vertex that is left without those.
std::optional<ReactionFromDual> from_dual(const convex::NearestPointProblem& problem,
                                          const GaussSolution& solution) {
  TwoSided at_vertex = solution.hypothesis.two_sided;
  if (!at_vertex.consistent)
    if (auto vertex = vertex_acceleration(problem)) {
      at_vertex.consistent = true;
      at_vertex.acceleration = *std::move(vertex);
    }
  return reaction_from_dual(problem, at_vertex, solution.primal);
}

/// The nearest point in units of which one is `norm` of ||q||_A as it was given. The tolerance is relative to
/// at least 1 there; where a large unit makes that too little, as where all forces are held, it is asked for
/// more.
convex::Solution nearest_point(const convex::NearestPointProblem& problem, const GaussOptions& options,
                               double norm) {
  const double tolerance = options.accuracy.tolerance;
  convex::Solution found = convex::bounded_where_decided(
      problem, options.method->solve(problem, options.accuracy), options.accuracy);
  const auto is_close = [&] {
    return found.error_bound <= tolerance * std::max(1 / norm, found.acceleration_norm);
  };
  if (norm <= 1 || found.status != convex::Status::solved || is_close()) return found;
  convex::Accuracy accuracy = options.accuracy;
  accuracy.tolerance = tolerance / norm;
  found = options.method->solve(problem, accuracy);
  if (found.status == convex::Status::inaccurate && is_close()) found.status = convex::Status::solved;
  return found;
}

GaussSolution solve_in_units(const convex::NearestPointProblem& problem, const GaussOptions& options,
                             double norm) {
  GaussSolution found;
  found.primal = nearest_point(problem, options, norm);
  if (found.primal.status == convex::Status::infeasible || found.primal.q.size() != problem.dimension())
    return found;
  if (!options.accuracy.reduce) found.reduced = reduced(problem, found.primal, options.accuracy);
  const double tolerance = zero_tolerance(options.accuracy);
  const bool ranges = options.always_ranges || problem.rows() <= most_ranges;
  found.multipliers = convex::multipliers(problem, found.primal, tolerance, ranges);
  if (found.primal.status == convex::Status::solved)
    found.touching = touching_contacts(problem, found.primal, found.multipliers, tolerance);
  const Vector& lambda = found.multipliers.least_norm;
  found.residuals = lambda == found.primal.lambda ? found.primal.residuals
                                                  : convex::residuals(problem, found.primal.q, lambda);
  found.reaction = reaction(problem, found.primal.q, lambda);
  found.gauss = found.primal.q.dot(0.5 * problem.A.multiply(found.primal.q) - problem.z);
  found.hypothesis = hypothesis(problem, found.primal, tolerance);
  if (problem.rows() <= most_contacts_from_dual) found.from_dual = from_dual(problem, found);
  return found;
}

/// Of an answer to numbers of which some became 0.
void leave_open(convex::Solution& primal) {
  if (primal.status == convex::Status::solved) primal.status = convex::Status::inaccurate;
  if (primal.status == convex::Status::infeasible) primal.status = convex::Status::gave_up;
  primal.error_bound = convex::infinity;
  primal.undecided = convex::open_question::range;
}

}  // namespace

GaussSolution solve(const convex::NearestPointProblem& problem, const GaussOptions& options) {
  if (const std::string reason = options.method->applies(problem); !reason.empty())
    throw convex::InvalidInput("method \"" + std::string(options.method->name) + "\": " + reason);
  const Units units = fit_units(problem);
  if (units.ordinary()) return solve_in_units(problem, options, 1);
  const convex::NearestPointProblem scaled = in_units(problem, units);
  GaussSolution found = solve_in_units(scaled, options, units.norm());
  restore_units(found, units, options.accuracy.tolerance);
  // With the default method fractions may be asked for what is lost; with others nothing is.
  const bool is_helped = options.method == &convex::methods().front() && options.accuracy.limit > 0;
  if (!is_helped && !problem.radii && !are_exact(problem, units, scaled)) leave_open(found.primal);
  return found;
}

}  // namespace mechanics
