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

TEST_CASE("two balls that touch have one point, whatever else the intersection holds or is added to it") {
  const std::pair<const char*, Vector> touching[] = {
      {"indicator(intersection(ball2(1, [2,0]), ball2(1)))", Eigen::Vector2d(1, 0)},
      {"indicator(intersection(ball2(3, [4,3]), ball_inf(7), ball2(2)))", Eigen::Vector2d(1.6, 1.2)},
      {"sum(norm1(2), indicator(intersection(ball2(0.5), ball2(4.5, [-3,4]))))", Eigen::Vector2d(-0.3, 0.4)}};
  const Metric W = Metric::dense(convex::Matrix{{4, 2}, {2, 10}});
  for (const auto& [text, point] : touching) {
    CAPTURE(text);
    const auto f = samples::function(text, 2);
    for (const Vector& z : {Vector(Eigen::Vector2d(-1e8, 2e8)), Vector(Eigen::Vector2d(0.5, 3))}) {
      const auto split = convex::decompose(f, z, W);
      CHECK(split.status == Status::solved);
      CHECK((split.x.x - point).norm() <= 1e-15);
    }
  }
}

TEST_CASE("a line that touches the ball of a support function on it has that function's value") {
  // The conjugate of 3 dist(., C) is the support function of C on the ball of radius 3, here at (-3, 0).
  const auto f =
      samples::function("precompose(conjugate(distance(ball2(1, [3,-2]), 3)), [[0],[-3]], [-3,-2])", 1);
  const auto split = convex::decompose(f, Vector::Constant(1, -60), Metric::identity(1));
  CHECK(split.status == Status::solved);
  CHECK(split.x.x[0] == -2.0 / 3);
  CHECK(std::abs(split.f_x - (3 * -3 + 3)) <= 1e-14);
}

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
