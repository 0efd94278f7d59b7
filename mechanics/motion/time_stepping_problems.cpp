#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/sparse/sparse_active_set.hpp"
#include "convex/nearest_point/sparse/sparse_interior_point.hpp"
#include "mechanics/motion/time_stepping.hpp"

namespace mechanics::inline motions {
namespace {

/// Numbers of rows are rounded about so many times.
constexpr double roundings_of_step_rows = 16;

/// Where very many rows change, velocities are found to this part of their size, far below the error of the
/// scheme, after a first one with rows that are not those of the middle of the step yet.
constexpr double first_velocity_part = 1e-4, velocity_part = 1e-7;

/// They are taken, and their error is told, where the method ends within the first part, or within the second
/// where the active set does not settle either.
constexpr double usual_part = 1e-5, far_part = 1e-3;
constexpr Index most_steps_inside = 40;

/// A rough correction of positions, of its own size; the next ones see to the rest.
constexpr double correction_part = 1e-3;

/// The active set is left for the interior-point method when it takes more steps than this to settle, and
/// tried again after some problems, and then after four times as many as the last time.
constexpr Index few_exchanges_of_step = 4;
constexpr int first_pause = 8, longest_pause = 512;

/// Whether the active set is tried for the next problems.
template <class Repeated>
void pause(Repeated& repeated, bool is_slow) {
  repeated.pause = is_slow ? std::clamp(4 * repeated.pause, first_pause, longest_pause) : 0;
  repeated.waited = 0;
}

/// By the interior-point method to this part of its size, in units in which that is about 1. near: what
/// solved a problem like it.
convex::Solution nearly_nearest(const convex::NearestPointProblem& problem, double part, const Vector& q,
                                const Vector& lambda) {
  const double size = std::max(problem.s.maxCoeff(), problem.A.solve(problem.z).cwiseAbs().maxCoeff());
  convex::Solution found;
  if (!(size > 0)) return found;
  convex::NearestPointProblem scaled = problem;
  scaled.z /= size;
  scaled.s /= size;
  scaled.radii.reset();
  convex::Accuracy accuracy;
  accuracy.tolerance = part;
  accuracy.step_limit = most_steps_inside;
  convex::Solution near;
  near.q = q / size;
  near.lambda = lambda / size;
  found = convex::sparse_interior_point(scaled, accuracy, near);
  for (Vector* x : {&found.q, &found.lambda, &found.slack}) *x *= size;
  for (double* x : {&found.error_bound, &found.acceleration_norm, &found.force_norm}) *x *= size;
  return found;
}

/// Rows that depend on each other exclude each other where rounding has made their right-hand sides: of rest,
/// the noise of v. One-sided rows ask for less by that, |u_a|·(|q| + |A⁻¹z|) rounded a few times.
void relax(convex::NearestPointProblem& problem) {
  const Vector size = problem.A.solve(problem.z).cwiseAbs();
  const double most = size.maxCoeff();
  for (Index a = 0; a < problem.rows(); ++a) {
    if (problem.is_two_sided(a)) continue;
    const double row =
        problem.U.is_sparse() ? problem.U.sparse().row(a).norm() : problem.U.dense().row(a).norm();
    problem.s[a] -= roundings_of_step_rows * convex::unit_roundoff * (std::abs(problem.s[a]) + row * most);
  }
}

bool same(const convex::ConstraintRows& a, const convex::ConstraintRows& b) {
  if (a.count() != b.count() || a.is_sparse() != b.is_sparse()) return false;
  if (!a.is_sparse()) return a.dense() == b.dense();
  const convex::SparseRows &x = a.sparse(), &y = b.sparse();
  return x.nonZeros() == y.nonZeros() &&
         std::equal(x.outerIndexPtr(), x.outerIndexPtr() + x.outerSize() + 1, y.outerIndexPtr()) &&
         std::equal(x.innerIndexPtr(), x.innerIndexPtr() + x.nonZeros(), y.innerIndexPtr()) &&
         std::equal(x.valuePtr(), x.valuePtr() + x.nonZeros(), y.valuePtr());
}

}  // namespace

convex::Solution Motion::TimeStepping::solution_of(Repeated& repeated,
                                                   const convex::NearestPointProblem& problem,
                                                   const std::vector<Index>& constraints, Effort effort) {
  convex::Accuracy accuracy;
  accuracy.limit = 0;  // a step is not worth fractions
  const bool large =
      problem.dimension() >= fewest_for_sparse_method && problem.rows() > 0 && problem.U.is_sparse();
  Vector before(problem.rows());
  for (std::size_t k = 0; k < constraints.size(); ++k)
    before[static_cast<Index>(k)] = repeated.lambda[constraints[k]];
  const auto is_found = [&](const convex::Solution& found) {
    return found.q.size() == problem.dimension() || found.status == convex::Status::infeasible;
  };
  std::vector<Index> pushing;
  for (std::size_t k = 0; k < constraints.size(); ++k)
    if (std::binary_search(repeated.pushing.begin(), repeated.pushing.end(), constraints[k]))
      pushing.push_back(static_cast<Index>(k));
  convex::Solution near;
  if (large && is_crowded_) {
    const bool is_start = effort == Effort::rough || effort == Effort::first;
    const bool tries = effort == Effort::exact || effort == Effort::first;
    const double part = effort == Effort::rough   ? correction_part
                        : effort == Effort::first ? first_velocity_part
                                                  : velocity_part;
    const auto within = [&](double bearable) {
      return is_found(near) &&
             near.error_bound <= bearable * std::max(near.acceleration_norm, near.force_norm);
    };
    if (!tries || repeated.waited < repeated.pause) {
      ++repeated.waited;
      near = nearly_nearest(problem, part, repeated.solution.q, before);
      if (is_start ? is_found(near) : within(usual_part)) return near;
    }
    if (is_found(near)) {
      pushing.clear();
      for (Index k = 0; k < near.lambda.size(); ++k)
        if (near.lambda[k] > 0) pushing.push_back(k);
    }
    if (!pushing.empty()) {
      accuracy.step_limit = few_exchanges_of_step;
      const convex::Solution found = convex::sparse_active_set(problem, accuracy, pushing);
      if (tries) pause(repeated, !is_found(found));
      if (is_found(found)) return found;
      if (!is_found(near)) near = nearly_nearest(problem, part, repeated.solution.q, before);
      if (is_start ? is_found(near) : within(far_part)) return near;
      accuracy.step_limit = 0;
    }
  }
  convex::Solution found = large ? convex::sparse_active_set(problem, accuracy, pushing)
                                 : convex::automatic(problem, accuracy, pushing);
  pause(repeated, found.steps > few_exchanges_of_step || !is_found(found));
  if (problem.rows() > 0 && !is_found(found))
    found = is_found(near) ? near : convex::sparse_interior_point(problem, accuracy);
  if (!large && !is_found(found)) {
    convex::NearestPointProblem relaxed = problem;
    relax(relaxed);
    found = convex::automatic(relaxed, accuracy, pushing);
  }
  return found;
}

const convex::Solution& Motion::TimeStepping::solve(Repeated& repeated, const std::vector<Index>& constraints,
                                                    const std::vector<Index>& two_sided,
                                                    const convex::ConstraintRows& U, const Vector& z,
                                                    const Vector& s, Effort effort) {
  convex::NearestPointProblem problem{*A_, z, U, s, two_sided};
  if (repeated.problem && repeated.problem->z == z && repeated.problem->s.size() == s.size() &&
      repeated.problem->s == s && repeated.problem->two_sided == two_sided && same(repeated.problem->U, U))
    return repeated.solution;
  problem.radii = convex::rounding_radii(problem, roundings_of_step_rows);
  if (repeated.lambda.size() == 0)
    repeated.lambda = Vector::Zero(static_cast<Index>(system.constraints().size()));
  repeated.solution = solution_of(repeated, problem, constraints, effort);
  repeated.pushing.clear();
  repeated.lambda.setZero();
  if (repeated.solution.lambda.size() == problem.rows())
    for (std::size_t k = 0; k < constraints.size(); ++k) {
      repeated.lambda[constraints[k]] = repeated.solution.lambda[static_cast<Index>(k)];
      if (repeated.lambda[constraints[k]] != 0) repeated.pushing.push_back(constraints[k]);
    }
  repeated.problem = std::move(problem);
  return repeated.solution;
}

}  // namespace mechanics::inline motions
