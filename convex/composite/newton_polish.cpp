#include "convex/composite/newton_polish.hpp"

#include <algorithm>

#include "convex/composite/newton_system.hpp"
#include "convex/gamma0/work_limit.hpp"

namespace convex::inline composite {
namespace {

constexpr double required_division = 0.7;
constexpr int step_limit = 60;
constexpr double near = 1e-2;  ///< theta over the relative residual

}  // namespace

Polished newton_polish(const SaddleProblem& problem, const SaddlePoint& from) {
  Polished polished;
  SaddlePoint& point = polished.point;
  point = saddle_point(problem, from.xi, from.u + from.y.cwiseQuotient(problem.D), problem.D);
  double least = polish_theta;
  for (int count = 0; count < step_limit && point.residual > 0 && !WorkLimit::passed();) {
    const double theta = std::clamp(near * point.residual / solution_size(problem, point), least, far_theta);
    const Vector ridge = polish_ridge * (least / polish_theta) * problem.R;
    const NewtonSystem system(problem, point.t, problem.D, theta, ridge);
    if (!system.usable()) break;
    const NewtonStep step = system.step(point.rho, point.r);
    bool kept = false;
    for (double length : {1.0, 0.5, 0.1}) {
      ++polished.evaluations;
      WorkLimit::count(WorkLimit::of_a_saddle_point);
      SaddlePoint next =
          saddle_point(problem, point.xi + length * step.dxi, point.t + length * step.dt, problem.D);
      if (!(next.residual <= required_division * point.residual) &&
          !(length < 1 && next.residual <= (1 - 0.3 * length) * point.residual))
        continue;
      point = std::move(next);
      kept = true;
      ++count;
      break;
    }
    if (kept) continue;
    // Where a term is nearly an edge, as log x near 0, or nearly flat, as e^x for x << 0, the parts that
    // guard against dependent rows and unbounded w hide its curvature: with less of them the step is Newton's
    // again.
    if (theta > least || least < 1e-5 * polish_theta) break;
    least *= 1e-3;
  }
  return polished;
}

}  // namespace convex::inline composite
