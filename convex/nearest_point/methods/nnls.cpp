#include "convex/nearest_point/methods/crossover.hpp"
#include "convex/nearest_point/methods/every_method.hpp"

#include "convex/linear_algebra/complete_orthogonal.hpp"
#include "convex/nearest_point/cone_projection.hpp"
#include "convex/nearest_point/reductions/whitened_problem.hpp"

namespace convex::inline algorithms {
namespace {

/// Bounds (of size 1) that a motion meets to this are consistent; a residual of the homogenised problem below
/// it is 0.
constexpr double consistent = 1e-12;

}  // namespace

Solution nnls(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const auto found = without_a_method(problem, "nnls", accuracy)) return *found;
  const WhitenedProblem white(problem);
  const Index n = problem.dimension(), k = white.size();
  const Vector vertex = linear_algebra::CompleteOrthogonal(white.V.transpose()).solve(white.b);
  Candidate candidate{.method = "nnls", .q = {}, .lambda = {}, .farkas = {}};
  candidate.finished = false;
  if ((white.V.transpose() * vertex - white.b).norm() <= consistent) {
    const ConeProjection cone = cone_projection(white.V, vertex, white.free_columns());
    candidate.lambda = white.multipliers(cone.lambda);
    candidate.finished = cone.finished;
    Solution found = crossover(problem, candidate, accuracy);
    if (found.status == Status::solved) return found;
  }
  Matrix E(n + 1, k);
  E << white.V, white.b.transpose();
  Vector target = Vector::Zero(n + 1);
  target[n] = 1;
  const ConeProjection cone = cone_projection(E, target, white.free_columns());
  const double rest = 1 - cone.point[n];  // |E y - e|² at the solution
  candidate.finished = cone.finished;
  if (rest > consistent * consistent) candidate.lambda = white.multipliers(cone.lambda / rest);
  if (rest <= 1e-6) candidate.farkas = white.weights(cone.lambda);
  return crossover(problem, candidate, accuracy);
}

}  // namespace convex::inline algorithms
