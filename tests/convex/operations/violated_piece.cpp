#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Decomposition;
using convex::Metric;
using convex::Status;
using convex::Vector;

TEST_CASE("where two curved pieces of a maximum meet far below the point, the prox lies on both") {
  // z - x = (1 - w) 2x + w e^x for a w in [0, 1], and |x|² = sum e^x.
  const Vector z = Eigen::Vector3d(-10, 50, 30);
  const auto f = samples::function("pointwise_max(power(2), exponential())", 3);
  const Decomposition split = convex::decompose(f, z, Metric::identity(3));
  REQUIRE(split.status == Status::solved);
  const Vector& x = split.x.x;
  const Vector exponential = x.array().exp().matrix(), force = z - x;
  CHECK(std::abs(x.squaredNorm() - exponential.sum()) <= 1e-11 * x.squaredNorm());
  const Vector between = exponential - 2 * x;
  const double w = (force - 2 * x).dot(between) / between.squaredNorm();
  CHECK(w > 0);
  CHECK(w < 1);
  CHECK((force - 2 * x - w * between).norm() <= 1e-11 * z.norm());
}

TEST_CASE("a piece that a point below the scale of the heights violates is seen") {
  // The slope is -1 to the left of 0 and 0 to its right.
  const auto f =
      samples::function("pointwise_max(max_affine([[3],[-1],[0],[-1]], [1,2,3,3]), norm2(1024))", 1);
  const Decomposition split =
      convex::decompose(f, Vector::Constant(1, -4.844264530885412e-07), Metric::identity(1));
  CHECK(split.status == Status::solved);
  CHECK(std::abs(split.x.x[0]) <= 1e-15);
}

TEST_CASE("a maximum that is smooth at the prox is solved there, whatever its other pieces leave open") {
  const Vector z = Eigen::Vector2d(14.05554365392309, 7.6261788042658365);
  const auto f = samples::function("pointwise_max(logistic(), squared_distance(orthant(), 3))", 2);
  const Decomposition split = convex::decompose(f, z, Metric::identity(2));
  CHECK(split.status == Status::solved);
  const Vector slope = (1 / (1 + (-split.x.x.array()).exp())).matrix();
  CHECK((z - split.x.x - slope).norm() <= 1e-13 * z.norm());
}
