#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/cones.hpp"
#include "convex/functions/sets.hpp"

using namespace convex;

TEST_CASE("a point of a set is its own projection within the bound, in a metric of condition 8e7 too") {
  const Metric W = Metric::dense(Matrix{{1.0000000149011612, 0.5}, {0.5, 0.25000001490116119}});
  const Function box = indicator(ball_inf(1));
  for (int k = 0; k < 2000; ++k) {
    const Vector z{{-1 + k * 0.001, 0.9 - k * 0.0007}};
    if (z.cwiseAbs().maxCoeff() > 1) continue;
    const Prox found = box.prox(z, W);
    CHECK(found.status == Status::solved);
    CHECK(W.norm(found.x - z) <= found.error_bound);
  }
  // W = ((2, 1), (1, 3)), z = (-1, 1/2): x = (0, 1/2 - 1/3).
  const Metric V = Metric::dense(Matrix{{2, 1}, {1, 3}});
  const Prox found = indicator(orthant()).prox(Vector{{-1, 0.5}}, V);
  CHECK(std::sqrt(3.0) * std::abs(found.x[1] - 1.0 / 6) <= found.error_bound);
}

TEST_CASE("a prox that leaves the domain where the metric is nearly singular is not called solved") {
  const Function f = support(halfspace(Vector{{-2, -98304, -6.103515625e-05}}, 1));
  const Metric W = Metric::dense(
      Matrix{{4.0000000000000071, -2, 2}, {-2, 1.0000000018626451, -1}, {2, -1, 1.0000000149011612}});
  const Prox found = f.prox(Vector::Constant(3, -1.1345839633714963), W);
  CHECK((found.status != Status::solved || W.norm(found.x) <= found.error_bound));  // 0 is right
  CHECK(f(found.x) < 1e-6);
}
