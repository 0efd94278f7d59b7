#include <algorithm>
#include <cmath>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/sparse/proportioned_gradients.hpp"
#include "convex/nearest_point/sparse/sparse_active_set.hpp"
#include "convex/nearest_point/sparse/sparse_interior_point.hpp"
#include "mechanics/motion/time_stepping.hpp"

namespace mechanics::inline motions {
namespace {

/// Numbers of rows are rounded about so many times.
constexpr double roundings_of_step_rows = 16;

/// Where very many rows change, velocities are found to this part of their size, far below the error of the
/// scheme; by gradients if so many steps of them are enough.
constexpr double velocity_part = 1e-7;
constexpr Index most_warm_steps = 60;

/// A rough correction of positions, of its own size; the next ones see to the rest.
constexpr double correction_part = 1e-3;

/// The active set is left for the interior-point method when it takes more steps than this to settle, and
/// tried again after some problems, and then after four times as many as the last time.
constexpr Index few_exchanges_of_step = 4;
constexpr int first_pause = 8, longest_pause = 512;

/// By the interior-point method to this part of its size, in units in which that is about 1. gave_up: it is
/// not found so well.
convex::Solution nearly_nearest(const convex::NearestPointProblem& problem, double part) {
  const double size = std::max(problem.s.maxCoeff(), problem.A.solve(problem.z).cwiseAbs().maxCoeff());
  convex::Solution found;
  if (!(size > 0)) return found;
  convex::NearestPointProblem scaled = problem;
  scaled.z /= size;
  scaled.s /= size;
  scaled.radii.reset();
  convex::Accuracy accuracy;
  accuracy.tolerance = part;
  found = convex::sparse_interior_point(scaled, accuracy);
  if (found.status != convex::Status::solved) found.status = convex::Status::gave_up;
  for (Vector* x : {&found.q, &found.lambda, &found.slack}) *x *= size;
  for (double* x : {&found.error_bound, &found.acceleration_norm, &found.force_norm}) *x *= size;
  return found;
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
  if (large && effort == Effort::warm && is_crowded_) {
    convex::Accuracy few;
    few.tolerance = velocity_part;
    few.step_limit = most_warm_steps;
    Vector guess(problem.rows());
    for (std::size_t k = 0; k < constraints.size(); ++k)
      guess[static_cast<Index>(k)] = repeated.lambda[constraints[k]];
    convex::Solution found = convex::proportioned_gradients(problem, few, guess);
    if (found.status == convex::Status::solved) return found;
  }
  const bool pauses = repeated.waited < repeated.pause;
  if (large && is_crowded_ && (effort == Effort::rough || pauses)) {
    ++repeated.waited;
    convex::Solution found =
        nearly_nearest(problem, effort == Effort::rough ? correction_part : velocity_part);
    const bool is_enough = effort == Effort::rough && found.q.size() == problem.dimension();
    if (is_enough || found.status == convex::Status::solved) return found;
  }
  std::vector<Index> guess;
  for (std::size_t k = 0; k < constraints.size(); ++k)
    if (std::binary_search(repeated.pushing.begin(), repeated.pushing.end(), constraints[k]))
      guess.push_back(static_cast<Index>(k));
  convex::Solution found = large ? convex::sparse_active_set(problem, accuracy, guess)
                                 : convex::automatic(problem, accuracy, guess);
  const bool is_slow = found.steps > few_exchanges_of_step || found.q.size() != problem.dimension();
  repeated.pause = is_slow ? std::clamp(4 * repeated.pause, first_pause, longest_pause) : 0;
  repeated.waited = 0;
  if (large && found.q.size() != problem.dimension() && found.status != convex::Status::infeasible)
    found = convex::sparse_interior_point(problem, accuracy);
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
