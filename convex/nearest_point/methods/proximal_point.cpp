#include "convex/nearest_point/methods/every_method.hpp"

#include "convex/nearest_point/methods/augmented_lagrangian.hpp"
#include "convex/nearest_point/methods/iteration.hpp"

namespace convex::inline algorithms {
namespace {

/// Newton steps in all.
constexpr Index most_steps = 2000;

/// theta falls at each new centre, down to the least one; Newton steps about one centre, and those that are
/// not damped.
struct ProximalSteps {
  std::string_view method;
  double theta, fall, least_theta;
  Index undamped, most_for_one;
};

Solution by_proximal_steps(const NearestPointProblem& problem, const Accuracy& accuracy,
                           const ProximalSteps& steps) {
  if (const auto found = without_a_method(problem, steps.method, accuracy)) return *found;
  const ScaledProblem scaled(problem);
  AugmentedLagrangian inner(scaled);
  inner.theta = steps.theta;
  Vector moved = inner.lambda;
  Index since = 0, centres = 0, next = 1;
  return iterate(
      problem, accuracy, most_steps,
      [&](Index) {
        if (!inner.newton_step(since >= steps.undamped) && ++since < steps.most_for_one) return false;
        since = 0;
        const Vector lambda = inner.multipliers();
        moved = lambda - inner.lambda;
        inner.lambda = lambda;
        inner.theta = std::max(steps.least_theta, steps.fall * inner.theta);
        if (++centres < next) return false;
        next = centres + 1 + centres / 4;
        return true;
      },
      [&](Index) { return unscaled(steps.method, scaled, scaled.motion(inner.q), inner.lambda, moved); });
}

}  // namespace

Solution proximal_point(const NearestPointProblem& problem, const Accuracy& accuracy) {
  return by_proximal_steps(problem, accuracy,
                           {.method = "proximal-point",
                            .theta = 1e-3,
                            .fall = 0.1,
                            .least_theta = 1e-8,
                            .undamped = 0,
                            .most_for_one = 100});
}

Solution semismooth_newton(const NearestPointProblem& problem, const Accuracy& accuracy) {
  return by_proximal_steps(problem, accuracy,
                           {.method = "semismooth-newton",
                            .theta = 1e-7,
                            .fall = 1,
                            .least_theta = 1e-7,
                            .undamped = 30,
                            .most_for_one = 300});
}

}  // namespace convex::inline algorithms
