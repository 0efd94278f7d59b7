#include "convex/nearest_point/methods/every_method.hpp"

#include <utility>

#include "convex/nearest_point/methods/iteration.hpp"
#include "convex/nearest_point/reductions/whitened_problem.hpp"

namespace convex::inline algorithms {
namespace {

constexpr double relaxation = 1.3;

constexpr Index most_sweeps = 1000000;

}  // namespace

Solution projected_gauss_seidel(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const auto found = without_a_method(problem, "projected-gauss-seidel", accuracy)) return *found;
  const WhitenedProblem white(problem);
  const Index k = white.size();
  Vector y = Vector::Zero(k), before = y, d = Vector::Zero(problem.dimension());
  return iterate(
      problem, accuracy, affordable_steps(problem, most_sweeps, most_work),
      [&](Index) {
        for (Index a = 0; a < k; ++a) {
          double next = y[a] + relaxation * (white.b[a] - white.V.col(a).dot(d));
          if (!white.is_free(a)) next = std::max(0.0, next);
          if (next == y[a]) continue;
          d += (next - y[a]) * white.V.col(a);
          y[a] = next;
        }
        return false;
      },
      [&](Index) {
        d.noalias() = white.V * y;  // what rounding has added up goes
        return unscaled("projected-gauss-seidel", white, {}, y, y - std::exchange(before, y));
      });
}

}  // namespace convex::inline algorithms
