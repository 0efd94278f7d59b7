#include "convex/nearest_point/methods/proximal_point.hpp"

#include "convex/nearest_point/methods/augmented_lagrangian.hpp"
#include "convex/nearest_point/methods/iteration.hpp"

namespace convex::inline algorithms {
namespace {

/// theta falls by this at each new centre, down to the least one.
constexpr double fall = 0.1, least_theta = 1e-8;

/// Newton steps in all, and for one centre.
constexpr Index most_steps = 2000, most_for_one = 100;

}  // namespace

Solution proximal_point(const NearestPointProblem& problem, const Accuracy& accuracy) {
  validate(problem);
  if (const auto found = without_a_method(problem, "proximal-point", accuracy)) return *found;
  const ScaledProblem scaled(problem);
  AugmentedLagrangian inner(scaled);
  Vector moved = inner.lambda;
  Index since = 0, centres = 0, next = 1;
  return iterate(
      problem, accuracy, most_steps,
      [&](Index) {
        if (!inner.newton_step(true) && ++since < most_for_one) return false;
        since = 0;
        const Vector lambda = inner.multipliers();
        moved = lambda - inner.lambda;
        inner.lambda = lambda;
        inner.theta = std::max(least_theta, fall * inner.theta);
        if (++centres < next) return false;
        next = centres + 1 + centres / 4;
        return true;
      },
      [&](Index) {
        return Candidate{.method = "proximal-point",
                         .q = scaled.motion(inner.q),
                         .lambda = scaled.multipliers(inner.lambda),
                         .farkas = scaled.weights(moved)};
      });
}

}  // namespace convex::inline algorithms
