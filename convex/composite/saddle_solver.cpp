#include "convex/composite/saddle_solver.hpp"

#include <algorithm>
#include <cmath>

#include "convex/composite/multiplier_step.hpp"
#include "convex/composite/newton_polish.hpp"

namespace convex {
namespace {

constexpr Index outer_limit = 60;
constexpr double growth = 8, largest_growth = 0x1p33;  ///< of D, by which outer steps converge superlinearly
constexpr double first_ridge = 1e-2, smallest_ridge = 1e-10;  ///< of the proximal term on w, times R
/// Below this part of the sizes of x and y there is only rounding; a few more steps are tried, then it stops.
constexpr double rounding_level = 1e-15;
constexpr Index patience = 4;  ///< outer steps without progress before the end
/// The domains are apart when the gap between M ξ + b and u stays this large beside them, and its direction
/// is a separating one: Mᵀ takes it to this part of its size.
constexpr double separated = 10 * membership_tolerance, separating = 1e-5;

/// Is the gap r of a step with a large D the shortest vector between the domains? Then Dr separates them.
bool separates(const SaddleProblem& problem, const SaddlePoint& point, const Vector& D) {
  const Vector normal = D.cwiseProduct(point.r);
  const SparseMatrix magnitude = problem.M.cwiseAbs();
  const double size = (magnitude.transpose() * normal.cwiseAbs()).norm();
  const double apart = point.r.norm();
  const double around = point.u.norm() + problem.b.norm() + (magnitude * point.xi.cwiseAbs()).norm();
  return apart > separated * around && (problem.M.transpose() * normal).norm() <= separating * size;
}

}  // namespace

SaddleSolution solve(const SaddleProblem& problem) {
  SaddleSolution solution;
  Vector xi = Vector::Zero(problem.n + problem.k);
  xi.head(problem.n) = problem.z;
  SaddlePoint best = saddle_point(problem, xi, problem.M * xi + problem.b, problem.D);
  const auto keep = [&](SaddlePoint point) {
    const bool better = point.residual < best.residual || !std::isfinite(best.residual);
    if (better) best = std::move(point);
    return better;
  };
  const auto finished = [&] { return best.residual <= rounding_level * solution_size(problem, best); };
  keep(newton_polish(problem, best));
  SaddlePoint centre = best;
  double factor = 1, ridge = first_ridge, last_gap = 0;
  Index idle = 0, apart = 0;
  for (; solution.outer_steps < outer_limit && !finished() && idle < patience; ++solution.outer_steps) {
    const Vector D = factor * problem.D;
    MultiplierStep step = multiplier_step(problem, centre, D, ridge * problem.R);
    solution.newton_steps += step.newton_steps;
    const double before = best.residual;
    const SaddlePoint polished = newton_polish(problem, step.point);
    const double gap = step.point.r.norm();
    apart = gap > 0.9 * last_gap && separates(problem, step.point, D) ? apart + 1 : 0;
    if (apart >= patience) {
      solution.infeasible = true;
      break;
    }
    last_gap = gap;
    centre = std::move(step.point);
    if (keep(polished) && best.residual <= 0.5 * before) centre = best;
    keep(centre);
    idle = best.residual <= 0.9 * before || factor < largest_growth ? 0 : idle + 1;
    if (best.residual <= 100 * rounding_level * solution_size(problem, best) && best.residual > 0.5 * before)
      break;
    if (step.minimised) factor = std::min(growth * factor, largest_growth);
    ridge = std::max(ridge / growth, smallest_ridge);
  }
  solution.point = std::move(best);
  return solution;
}

}  // namespace convex
