#include <doctest/doctest.h>

#include <cmath>

#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/prox.hpp"
#include "convex/linear_quadratic/value.hpp"
#include "tests/convex/linear_quadratic/samples.hpp"

using convex::Index;
using convex::LinearQuadratic;
using convex::Metric;
using convex::Prox;
using convex::Status;
using convex::Vector;
namespace lq = convex::linear_quadratic;

namespace {

/// What a metric of condition 10⁶ leaves of the sixteen digits, ten roundings and a factor sqrt(10⁶) of them.
constexpr double left_by_condition = 2e-12;

}  // namespace

TEST_CASE(
    "a point is the sum of its prox and of the conjugate's, found from the dual program, in any metric") {
  std::mt19937 generator(1);
  for (Index n : {1, 2, 3, 6})
    for (const auto& [name, f] : samples::catalogue(n)) {
      const LinearQuadratic dual = lq::conjugate(f);
      for (double condition : {1.0, 1e3, 1e6})
        for (double scale : {1.0, 1e6, 1e-3}) {
          CAPTURE(name);
          CAPTURE(n);
          CAPTURE(condition);
          CAPTURE(scale);
          const Metric W = samples::random_metric(generator, n, condition);
          const Vector z = samples::tied_point(generator, n, scale);
          const Prox x = prox(f, z, W), y = prox(lq::conjugate(f, W), z, W);
          REQUIRE(x.status == Status::solved);
          REQUIRE(y.status == Status::solved);
          const double size = W.norm(z) + W.norm(x.x) + 1e-3 / std::sqrt(condition);
          CHECK(W.norm(x.x + y.x - z) <= left_by_condition * size);
          CHECK(W.norm(x.x + y.x - z) <=
                4 * (x.error_bound + y.error_bound) + 4e-16 * std::sqrt(condition) * size);
          CHECK(W.dual_norm(x.v - W.multiply(z - x.x)) <= 10 * left_by_condition * size);
        }
    }
}

TEST_CASE("at a prox the values of f and of its conjugate add up to the product, by the dual and directly") {
  std::mt19937 generator(2);
  for (Index n : {1, 3, 5})
    for (const auto& [name, f] : samples::catalogue(n)) {
      const LinearQuadratic dual = lq::conjugate(f);
      for (int repeat = 0; repeat < 3; ++repeat) {
        CAPTURE(name);
        CAPTURE(n);
        const Metric W = samples::random_metric(generator, n, 100);
        const Prox found = prox(f, samples::tied_point(generator, n, 1), W);
        const double fx = value(f, found.x), gv = value(dual, found.v), product = found.x.dot(found.v);
        const double size = std::abs(fx) + std::abs(gv) + found.x.norm() * found.v.norm() + 1e-3;
        CHECK(std::abs(fx + gv - product) <= 1e-12 * size);
        const double direct = supremum(f, found.v);
        CHECK((std::abs(direct - gv) <= 1e-12 * size || direct == std::numeric_limits<double>::infinity()));
        CHECK(subgradient_defect(f, found.v, found.x) <= 1e-11 * (found.x.norm() + found.v.norm()));
      }
    }
}

TEST_CASE("a prox is firmly nonexpansive, and the value at it is not above that at points around") {
  std::mt19937 generator(3);
  const Index n = 4;
  for (const auto& [name, f] : samples::catalogue(n)) {
    CAPTURE(name);
    const Metric W = samples::random_metric(generator, n, 1e4);
    const Vector z = samples::tied_point(generator, n, 1), other = samples::tied_point(generator, n, 1);
    const Vector x = prox(f, z, W).x, y = prox(f, other, W).x;
    const double size = std::pow(W.norm(z - other), 2);
    CHECK(std::pow(W.norm(x - y), 2) <= W.inner(x - y, z - other) + 1e-12 * size);
    const auto objective = [&](const Vector& u) { return 0.5 * std::pow(W.norm(u - z), 2) + value(f, u); };
    const double least = objective(x);
    for (const Vector& u : {y, Vector(0.5 * (x + y)), Vector(x + 1e-3 * (y - x))})
      CHECK(objective(u) >= least - 1e-12 * (std::abs(least) + size));
  }
}

TEST_CASE("f is its biconjugate") {
  std::mt19937 generator(4);
  for (Index n : {1, 3})
    for (const auto& [name, f] : samples::catalogue(n)) {
      CAPTURE(name);
      CAPTURE(n);
      const LinearQuadratic twice = lq::conjugate(lq::conjugate(f));
      const Vector z = samples::tied_point(generator, n, 1);
      const Metric W = samples::random_metric(generator, n, 10);
      const Vector x = prox(f, z, W).x;
      CHECK((prox(twice, z, W).x - x).norm() <= 1e-12 * (z.norm() + x.norm()));
      for (const Vector& u : {x, z}) {
        const double once = value(f, u);
        if (std::isinf(once))
          CHECK(value(twice, u) == once);
        else
          CHECK(std::abs(value(twice, u) - once) <= 1e-12 * (1 + std::abs(once)));
      }
    }
}

TEST_CASE("fifty entries in an ill-conditioned metric are found as well") {
  std::mt19937 generator(5);
  const Index n = 50;
  for (const auto& [name, f] : samples::catalogue(n)) {
    if (name != "norm1" && name != "max" && name != "total_variation" && name != "ball1") continue;
    CAPTURE(name);
    const Metric W = samples::random_metric(generator, n, 1e6);
    const Vector z = samples::tied_point(generator, n, 1);
    const Prox x = prox(f, z, W), y = prox(lq::conjugate(f, W), z, W);
    CHECK(x.status == Status::solved);
    CHECK(W.norm(x.x + y.x - z) <= left_by_condition * W.norm(z));
  }
}

TEST_CASE("where the metric is nothing beside the quadratic part, the prox gives up without a point") {
  convex::LinearQuadraticBuilder builder(2, 0);
  for (const auto& [i, j] : {std::pair<Index, Index>{0, 0}, {0, 1}, {1, 1}}) builder.curve(i, j, 1e20);
  const Prox found = prox(builder.finish(), Vector{{1, 2}}, Metric::identity(2).scaled(1e-20));
  CHECK(found.status == Status::gave_up);
  CHECK(found.x.size() == 0);
}
