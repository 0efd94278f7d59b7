#include "convex/nearest_point/methods/semismooth_newton.hpp"

#include "convex/nearest_point/methods/augmented_lagrangian.hpp"
#include "convex/nearest_point/methods/iteration.hpp"

namespace convex::inline algorithms {
namespace {

/// The regularisation of rows of length 1.
constexpr double theta = 1e-7;

/// Undamped steps about one centre.
constexpr Index most_undamped = 30;
constexpr Index most_steps = 2000;

}  // namespace

Solution semismooth_newton(const NearestPointProblem& problem, const Accuracy& accuracy) {
  validate(problem);
  if (const auto found = without_a_method(problem, "semismooth-newton", accuracy)) return *found;
  const ScaledProblem scaled(problem);
  AugmentedLagrangian inner(scaled);
  inner.theta = theta;
  Vector moved = inner.lambda;
  Index since = 0, centres = 0, next = 1;
  return iterate(
      problem, accuracy, most_steps,
      [&](Index) {
        if (!inner.newton_step(since++ >= most_undamped) && since < 10 * most_undamped) return false;
        since = 0;
        const Vector lambda = inner.multipliers();
        moved = lambda - inner.lambda;
        inner.lambda = lambda;
        if (++centres < next) return false;
        next = centres + 1 + centres / 4;
        return true;
      },
      [&](Index) {
        return Candidate{.method = "semismooth-newton",
                         .q = scaled.motion(inner.q),
                         .lambda = scaled.multipliers(inner.lambda),
                         .farkas = scaled.weights(moved)};
      });
}

}  // namespace convex::inline algorithms
