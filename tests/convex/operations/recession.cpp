#include <doctest/doctest.h>

#include "convex/gamma0/node.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Function;
using convex::Vector;

namespace {

constexpr const char* far_expressions[] = {
    "entropy()",
    "logistic()",
    "log_barrier()",
    "negative_power(0.5)",
    "binary_entropy()",
    "huber(0.5)",
    "hinge()",
    "quadratic([[4,2],[2,1]], [1,-3])",
    "max_affine([[1,2],[-1,0],[0,3]], [1,0,2])",
    "indicator(halfspace([1,2], 3))",
    "indicator(polyhedron([[1,2],[-1,0]], [3,1]))",
    "indicator(second_order_cone())",
    "indicator(ball2(2, [1,1]))",
    "norm2(3)",
    "distance(orthant(), 2)",
    "tilt(exponential(), [1,-2])",
    "translate(entropy(), [1,-1])",
    "scale(dilate(logistic(), -2), 3)",
    "sum(hinge(), exponential())",
    "pointwise_max(power(2), exponential())",
    "precompose(logistic(), [[1,2],[0,1],[3,-1]], [1,0,2])",
    "precompose(entropy(), [[2,1],[1,1]], [1,0])",
    "separable(entropy(), 1, hinge(), 1)",
    "envelope(log_barrier(), 2)",
    "inf_convolution(exponential(), norm1(2))",
    "proximal_average(logistic(), hinge(), 0.25, 2)",
    "perspective(logistic())",
    "indicator(epigraph(exponential()))",
    "conjugate(pointwise_max(power(2), exponential()))",
    "conjugate(sum(logistic(), norm2(1)))",
    "conjugate(quadratic([[4,2],[2,1]], [1,-3]))",
};

std::vector<Vector> directions() {
  std::vector<Vector> all;
  for (int i = 0; i < 16; ++i) all.push_back(Eigen::Vector2d(std::cos(i * M_PI / 8), std::sin(i * M_PI / 8)));
  for (const double a : {1.0, -1.0}) all.push_back(Eigen::Vector2d(a, -2 * a) / std::sqrt(5.0));
  return all;
}

/// A point of the domain: a prox is one.
Vector inside(const Function& f, const Vector& z) { return f.prox(z, convex::Metric::identity(2)).x; }

}  // namespace

TEST_CASE("along a direction a function rises by no more than its recession function says") {
  for (const char* text : far_expressions) {
    CAPTURE(text);
    const Function f = samples::function(text, 2);
    for (const Vector& z : samples::points(2))
      for (const Vector& d : directions()) {
        const double slope = f.node().recession(d);
        if (!(slope < std::numeric_limits<double>::infinity())) continue;
        CAPTURE(d.transpose());
        const Vector x = inside(f, z);
        const double here = f(x);
        for (const double step : {0.5, 10.0, 1e4}) {
          const double there = f(x + step * d);
          CHECK(there - here <= step * slope + 1e-8 * (1 + std::abs(here) + step * (1 + std::abs(slope))));
        }
      }
  }
}

TEST_CASE("no point of the domain is beyond the support function of the domain") {
  for (const char* text : far_expressions) {
    CAPTURE(text);
    const Function f = samples::function(text, 2);
    for (const Vector& z : samples::points(2))
      for (const Vector& v : directions()) {
        CAPTURE(v.transpose());
        const Vector x = inside(f, 30 * z);
        CHECK(v.dot(x) <= f.node().domain_support(v) + 1e-8 * (1 + x.norm()));
      }
  }
}

TEST_CASE("the two are those of the conjugate, the other way round, where both are known") {
  const auto both = [](double a, double b) { return std::isfinite(a) && std::isfinite(b); };
  for (const char* text : far_expressions) {
    CAPTURE(text);
    const Function f = samples::function(text, 2), g = f.conjugate();
    for (const Vector& d : directions()) {
      CAPTURE(d.transpose());
      const double slope = f.node().recession(d), of_g = g.node().domain_support(d);
      if (both(slope, of_g)) CHECK(slope == doctest::Approx(of_g).epsilon(1e-9));
      const double reach = f.node().domain_support(d), slope_of_g = g.node().recession(d);
      if (both(reach, slope_of_g)) CHECK(reach == doctest::Approx(slope_of_g).epsilon(1e-9));
    }
  }
}
