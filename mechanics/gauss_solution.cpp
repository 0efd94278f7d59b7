#include "mechanics/gauss_solution.hpp"

#include <cmath>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "mechanics/dependent_rows.hpp"
#include "mechanics/exact_gauss_solution.hpp"
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
                                          const GaussSolution& solution, double limit) {
  TwoSided at_vertex = solution.hypothesis.two_sided;
  if (!at_vertex.consistent)
    if (auto vertex = vertex_acceleration(problem, limit)) {
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

/// An answer without some rows, as one with all.
convex::Solution with_all_rows(const convex::NearestPointProblem& problem, convex::Solution found,
                               const std::vector<Index>& kept) {
  const Vector lambda = found.lambda;
  found.lambda = Vector::Zero(problem.rows());
  for (std::size_t k = 0; k < kept.size(); ++k) found.lambda[kept[k]] = lambda[static_cast<Index>(k)];
  for (Index& row : found.basis) row = kept[static_cast<std::size_t>(row)];
  found.slack = problem.U.times(found.q) - problem.s;
  found.residuals = convex::residuals(problem, found);
  return found;
}

/// Rows that depend on two-sided ones within their radii count as dependent and consistent. The default
/// method sees to that; a method that was named is asked without them, and its answer stands where it keeps
/// them within the radii.
convex::Solution nearest_point_of_consistent_rows(const convex::NearestPointProblem& problem,
                                                  const GaussOptions& options, double norm) {
  const auto with_all = [&] { return nearest_point(problem, options, norm); };
  if (!problem.radii || options.method == &convex::methods().front()) return with_all();
  const std::vector<DependentRow> dependent = dependent_rows(problem, RowsCompared::all);
  if (dependent.empty()) return with_all();
  std::vector<bool> is_left_out(static_cast<std::size_t>(problem.rows()));
  for (const DependentRow& one : dependent) is_left_out[static_cast<std::size_t>(one.row)] = true;
  std::vector<Index> kept, two_sided;
  for (Index a = 0; a < problem.rows(); ++a) {
    if (is_left_out[static_cast<std::size_t>(a)]) continue;
    if (problem.is_two_sided(a)) two_sided.push_back(static_cast<Index>(kept.size()));
    kept.push_back(a);
  }
  convex::Solution found = nearest_point({problem.A, problem.z, problem.U.select(kept), problem.s(kept),
                                          std::move(two_sided), convex::select(problem.radii, kept)},
                                         options, norm);
  if (found.status != convex::Status::solved && found.status != convex::Status::inaccurate) return with_all();
  found = with_all_rows(problem, std::move(found), kept);
  const double size = std::sqrt(found.q.cwiseAbs2().dot(problem.A.diagonal()));
  const auto way = [&](Index a) { return problem.radii->s[a] + problem.radii->row[a] * size; };
  std::vector<Index> left_out;
  for (const DependentRow& one : dependent) left_out.push_back(one.row);
  const Vector length = convex::dual_lengths(problem, left_out);
  for (const DependentRow& one : dependent) {
    double allowed = way(one.row) + length[one.row] * found.error_bound;
    for (const auto& [a, weight] : one.others) allowed += std::abs(weight) * way(a);
    const double slack = found.slack[one.row];
    if (!((problem.is_two_sided(one.row) ? std::abs(slack) : -slack) <= allowed)) return with_all();
  }
  return found;
}

GaussSolution solve_in_units(const convex::NearestPointProblem& problem, const GaussOptions& options,
                             double norm) {
  GaussSolution found;
  found.primal = nearest_point_of_consistent_rows(problem, options, norm);
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
  // Where fractions have not decided q within their limit, they are not asked for what follows from it; and
  // where they have, not for a second way.
  const double limit = found.primal.undecided.empty() ? options.accuracy.limit : 0,
               limit_of_other_way = is_decided_in_fractions(found.primal) ? 0 : limit;
  found.hypothesis = hypothesis(problem, found.primal, tolerance, limit);
  if (problem.rows() <= most_contacts_from_dual)
    found.from_dual = from_dual(problem, found, limit_of_other_way);
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
  if (options.method == nullptr) throw convex::InvalidInput("method: none; give one of convex::methods()");
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
