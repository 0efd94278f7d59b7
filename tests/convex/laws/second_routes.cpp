#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "convex/functions/norms.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/separable_functions.hpp"
#include "convex/functions/sets.hpp"
#include "convex/laws/cutting_planes.hpp"
#include "convex/laws/nearest_by_support.hpp"
#include "convex/laws/trial.hpp"

using namespace convex;

TEST_CASE(
    "support points alone find the projection on a ball and on a polytope, in any metric, within the bound") {
  for (const NamedMetric& metric : trial_metrics(3))
    for (const Vector& z : trial_points(3))
      for (const Function& support : {norm2(2), max(), norm1(1.5)}) {
        CAPTURE(metric.name);
        CAPTURE(z.transpose());
        const auto found = nearest_by_support(
            [&](const Vector& c) { return support.subgradient(metric.W.multiply(c)); }, z, metric.W);
        REQUIRE(found);
        const Prox right = support.conjugate().prox(z, metric.W);
        CHECK(metric.W.norm(found->x - right.x) <=
              found->error_bound + right.error_bound + rounding_bound(metric.W, z, right.x));
      }
}

TEST_CASE(
    "the bound of a route by support points is small where it should be: seven digits in good metrics") {
  for (const Vector& z : trial_points(3)) {
    const Metric W = Metric::diagonal(Vector{{1, 2, 3}});
    const Function support = norm2(2);
    const auto found =
        nearest_by_support([&](const Vector& c) { return support.subgradient(W.multiply(c)); }, z, W);
    REQUIRE(found);
    CHECK(found->error_bound <= 1e-7 * (1 + W.norm(z)));
  }
}

TEST_CASE("cutting planes find the prox of a smooth and of a kinked function within the bound") {
  for (const Vector& z : {Vector{{1, -2, 0.5}}, Vector{{0, 0, 0}}, Vector{{3, 3, 3}}})
    for (const Function& f : {logistic(), norm_inf(1), norm2(1)}) {
      const Metric W = Metric::dense(matrix_of_condition(3, 10));
      CAPTURE(z.transpose());
      CAPTURE(to_text(f.call()));
      const auto found = prox_by_cutting_planes([&](const Vector& x) { return f(x); },
                                                [&](const Vector& x) { return f.subgradient(x); }, z, W);
      REQUIRE(found);
      const Prox right = f.prox(z, W);
      CHECK(W.norm(found->x - right.x) <= found->error_bound + right.error_bound);
      CHECK(found->error_bound <= 1e-3);
    }
}

TEST_CASE("a route without support points, or from an infinite value, is none") {
  const Metric W = Metric::identity(2);
  CHECK_FALSE(nearest_by_support([](const Vector&) { return std::nullopt; }, Vector{{1, 2}}, W));
  CHECK_FALSE(prox_by_cutting_planes([](const Vector&) { return std::numeric_limits<double>::infinity(); },
                                     [](const Vector& x) { return std::optional<Vector>(x); }, Vector{{1, 2}},
                                     W));
}
