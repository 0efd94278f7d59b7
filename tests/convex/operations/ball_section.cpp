#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Metric;
using convex::Status;
using convex::Vector;

namespace {

/// A line that touches a ball at x: |Ax + b - center| is the radius there, and more elsewhere.
struct Touching {
  const char* f;
  double x;
};
constexpr Touching lines[] = {
    {"precompose(indicator(ball2(1, [-1,3])), [[0],[-2]], [-2,0])", -1.5},
    {"precompose(indicator(ball2(2)), [[0],[-1]], [2,-1])", -1},
    {"precompose(indicator(ball2(5)), [[4],[-3]], [3,4])", 0},
    {"precompose(indicator(ball2(0, [3,4,0])), [[3],[4],[0]], [0,0,0])", 1},
};

}  // namespace

TEST_CASE("a line that touches a ball has one point of it, which is every point's nearest") {
  for (const auto& [text, x] : lines) {
    CAPTURE(text);
    const auto f = samples::function(text, 1);
    for (const double z : {-3.0, 0.25, 1e8, -1e-8}) {
      const auto split = convex::decompose(f, Vector::Constant(1, z), Metric::identity(1));
      CHECK(split.status == Status::solved);
      CHECK(split.x.x[0] == x);
      CHECK(split.y.x[0] == z - x);
    }
  }
}

TEST_CASE("the plane section of a ball is a ball: the ends of its chords, and nothing of their other side") {
  // |2x - 1|² + |2y|² + 1 <= 17/4 about (1/2, 0), radius sqrt(13)/4
  const auto f = samples::function(
      "precompose(indicator(ball2(2.0615528128088303, [1,0,0])), [[2,0],[0,2],[0,0]], [0,0,1])", 2);
  const double radius = std::sqrt(13.0) / 4;
  for (const double angle : {0.0, 0.7, 2.0, 4.1}) {
    const Vector out = Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const Vector z = Eigen::Vector2d(0.5, 0) + 7 * out;
    const auto split = convex::decompose(f, z, Metric::identity(2));
    CHECK(split.status == Status::solved);
    CHECK((split.x.x - Eigen::Vector2d(0.5, 0) - radius * out).norm() <= 1e-14);
  }
}
