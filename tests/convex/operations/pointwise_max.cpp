#include <doctest/doctest.h>

#include "convex/functions/decomposition.hpp"
#include "convex/laws/trial.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Metric;
using convex::Prox;
using convex::Vector;

namespace {

/// The length r of prox z for max(r²/2, r), and its conjugate at slopes of length s.
double prox_length(double z) {
  if (z <= 3) return std::max(0.0, z - 1);
  return z < 4 ? 2 : z / 2;
}
double conjugate_value(double s) {
  if (s <= 1) return 0;
  return s < 2 ? 2 * (s - 1) : s * s / 2;
}

}  // namespace

TEST_CASE("the maximum of a norm and its square bends at a sphere, for points of any length") {
  const auto f = samples::function("pointwise_max(squared_norm2(), norm2())", 3);
  const auto g = f.conjugate();
  const Metric plain = Metric::identity(3);
  const Vector direction = Eigen::Vector3d(2, -1, 2) / 3;
  for (double length : {1e-9, 0.5, 2.0, 3.25, 3.999, 4.001, 1e3, 1e6, 1e8}) {
    CAPTURE(length);
    const Vector z = length * direction;
    const Prox x = f.prox(z, plain);
    CHECK(x.status == convex::Status::solved);
    CHECK((x.x - prox_length(length) * direction).norm() <= 1e-12 * length);
    CHECK(std::abs(g(z) - conjugate_value(length)) <= 1e-10 * (conjugate_value(length) + length));
  }
}

TEST_CASE("at the prox of a maximum of curved functions, the conjugate is finite and f(x) + g(y) = (x|y)") {
  for (const char* text :
       {"pointwise_max(squared_norm2(), norm1())", "pointwise_max(norm2(), exponential())"}) {
    const auto f = samples::function(text, 3);
    for (const convex::NamedMetric& metric : convex::trial_metrics(3)) {
      const auto g = f.conjugate(metric.W);
      for (double size : {1e-6, 1.0, 1e6}) {
        CAPTURE(text);
        CAPTURE(metric.name);
        CAPTURE(size);
        const Vector z = size * Eigen::Vector3d(-0.3, 0.7, -0.2);
        const Prox x = f.prox(z, metric.W), y = g.prox(z, metric.W);
        const double scale = metric.W.norm(z) + metric.W.norm(x.x);
        CHECK(x.error_bound <= 1e-12 * scale);
        CHECK(y.error_bound <= 1e-12 * scale);
        const double inner = metric.W.inner(x.x, y.x);
        CHECK(std::abs(f(x.x) + g(y.x) - inner) <=
              1e-9 * (std::abs(f(x.x)) + std::abs(inner) + scale * scale));
      }
    }
  }
}

TEST_CASE("what a part leaves open far below another leaves nothing of the maximum open") {
  const auto below = samples::function("proximal_average(binary_entropy(), power(1.5), 0.5, 2)", 1);
  const auto f =
      samples::function("pointwise_max(proximal_average(binary_entropy(), power(1.5), 0.5, 2), norm1())", 1);
  const Vector z = Vector::Zero(1);
  REQUIRE(below.evaluate(z).error > 0);
  REQUIRE(below(z) < -0.1);
  const convex::Value at_zero = f.evaluate(z);
  CHECK(at_zero.value == 0);
  CHECK(at_zero.error == 0);
}

TEST_CASE(
    "functions of the line whose domains meet in one point have the larger value there as their maximum") {
  // -1024 sqrt(x) for x >= 0, and a conjugate for x <= 0 alone, 0 at 0.
  const auto f =
      samples::function("pointwise_max(scale(negative_power(0.5), 1024), conjugate(inverse_power(0.5)))", 1);
  for (const double z : {3.0, -1e8}) {
    const auto split = convex::decompose(f, Vector::Constant(1, z), Metric::identity(1));
    CHECK(split.status == convex::Status::solved);
    CHECK(split.x.x[0] == 0);
    CHECK(split.f_x == 0);
    CHECK(split.y.x[0] == z);
  }
}
