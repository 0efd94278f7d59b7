#include "convex/nearest_point/sparse/sparse_interior_point.hpp"

#include <cmath>

#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/sparse/interior_point_start.hpp"

namespace convex::inline sparse {
namespace {

constexpr std::string_view method_name = "sparse-interior-point";

/// Means of multiplier times slack, scaled, one after the other as long as they are reached.
constexpr double first_mean = 1e-6, last_mean = 1e-18, ever_smaller = 1e-1;

/// Below this, a mean that makes the bound no smaller is the last.
constexpr double trusted_mean = 1e-9;

/// The point of a start, without a bound of its error.
Solution point_of(const NearestPointProblem& problem, const BalancedProblem& scaled,
                  const InteriorPointStart& start) {
  Vector lambda = start.lambda().cwiseProduct(scaled.multiplier);
  for (Index a = 0; a < problem.rows(); ++a)
    if (!start.looks_active(a)) lambda[a] = 0;
  Solution now = measured(problem, start.q().cwiseProduct(scaled.coordinate), lambda);
  now.method = method_name;
  now.steps = start.steps();
  now.farkas = Vector::Zero(problem.rows());
  return now;
}

bool settle(Solution& now, const Accuracy& accuracy, double error) {
  now.error_bound = error;
  now.status = now.is_within(accuracy) ? Status::solved : Status::inaccurate;
  return now.status == Status::solved;
}

Solution approached(const NearestPointProblem& problem, const Accuracy& accuracy,
                    const BalancedProblem& scaled, InteriorPointStart& start) {
  start.stand_alone(accuracy.step_limit);
  Solution best;
  best.method = method_name;
  best.farkas = Vector::Zero(problem.rows());
  for (double mean = first_mean; mean >= last_mean; mean *= ever_smaller) {
    const InteriorPointStart::End end = start.approach(mean);
    if (end == InteriorPointStart::End::unbounded || start.q().size() != problem.dimension()) break;
    if (!start.q().allFinite() || !start.lambda().allFinite()) break;
    if (best.q.size() > 0 && start.steps() == best.steps && end == InteriorPointStart::End::close) continue;
    Solution now = point_of(problem, scaled, start);
    // ||q - q*||_A is at most the root of the duality gap, where the rows are kept.
    const Residuals& r = now.residuals;
    const bool is_close =
        settle(now, accuracy,
               (r.duality_gap + r.stationarity) * std::max(now.acceleration_norm, now.force_norm) +
                   r.feasibility * now.acceleration_norm);
    const bool is_better = best.q.size() == 0 || now.error_bound < best.error_bound;
    if (!is_better && mean < trusted_mean) break;
    if (is_better) best = std::move(now);
    if (is_close || end == InteriorPointStart::End::stalled) break;
  }
  return best;
}

}  // namespace

Solution sparse_interior_point(const NearestPointProblem& problem, const Accuracy& accuracy,
                               const Solution& guess) {
  validate(problem);
  const BalancedProblem scaled = balanced_problem(problem);
  RowSystem system(scaled);
  const Vector free = problem.A.solve(problem.z).cwiseQuotient(scaled.coordinate);
  Solution near;
  if (problem.rows() > 0 && guess.q.size() == problem.dimension() && guess.lambda.size() == problem.rows()) {
    InteriorPointStart start(scaled, system, free);
    const double left = start.start_near(guess.q.cwiseQuotient(scaled.coordinate),
                                         guess.lambda.cwiseQuotient(scaled.multiplier), accuracy.tolerance);
    if (left < infinity) {
      near = point_of(problem, scaled, start);
      const double unit = scaled.coordinate[0] * std::sqrt(problem.A.diagonal()[0]);
      settle(near, accuracy, unit * left);
    } else {
      near = approached(problem, accuracy, scaled, start);
    }
    if (near.status == Status::solved || !start.began_near()) return near;
  }
  InteriorPointStart start(scaled, system, free);
  Solution found = approached(problem, accuracy, scaled, start);
  const bool is_better = found.q.size() > 0 && !(near.error_bound <= found.error_bound);
  return near.q.size() == 0 || is_better ? found : near;
}

}  // namespace convex::inline sparse
