#include <doctest/doctest.h>

#include <cmath>

#include "convex/laws/trial.hpp"
#include "convex/operations/operations.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Metric;
using convex::Prox;
using convex::Vector;

TEST_CASE(
    "in a product of condition a million, the proxes of f and of its conjugate give z to twelve digits") {
  for (const char* text :
       {"ball2(2)", "norm2(0.5)", "second_order_cone()", "exponential_cone()", "power_cone(0.3)", "entropy()",
        "group_norm(1, [2,1])", "tilt(norm2(), [1,-2,3])", "sum(norm2(), indicator(box(-1, 2)))",
        "sum(norm2(), quadratic([[2,1,0],[1,2,0],[0,0,1]], [1,0,-1]))"}) {
    CAPTURE(text);
    const convex::Function f = samples::function(text, 3);
    for (const convex::NamedMetric& metric : convex::trial_metrics(3)) {
      CAPTURE(metric.name);
      const Metric& W = metric.W;
      const convex::Function g = f.conjugate(W);
      for (const Vector& point : convex::trial_points(3))
        for (const double size : {1e-3, 1.0}) {
          const Vector z = size * point;
          const Prox x = f.prox(z, W), y = g.prox(z, W);
          const double scale = W.norm(z) + W.norm(x.x);
          CHECK(W.norm(z - x.x - y.x) <= 1e-12 * scale);
          CHECK(x.error_bound <= 1e-12 * scale);
          CHECK(y.error_bound <= 1e-12 * scale);
        }
    }
  }
}

TEST_CASE("the conjugate in a product of a support function in it is the indicator of the set as it was") {
  // The condition of the product must not widen the tolerance by which a point counts as one of the set.
  const char* set = "ball2(2, center=[1,0,-1])";
  for (const convex::NamedMetric& metric : convex::trial_metrics(3)) {
    CAPTURE(metric.name);
    const Metric& W = metric.W;
    const convex::Function support =
        convex::in_product(samples::function(set, 3).conjugate(), W);  // sup of (s|x) over the set
    const convex::Function inside = support.conjugate(W), twice = support.conjugate().conjugate();
    for (Vector direction : convex::trial_points(3)) {
      if (!(direction.norm() > 0)) continue;
      direction /= direction.norm();
      const Vector center{{1, 0, -1}};
      CHECK(inside(center + 2 * direction) == 0);
      CHECK(std::isinf(inside(center + (2 + 1e-6) * direction)));
      CHECK(twice(direction) == support(direction));
    }
  }
}
