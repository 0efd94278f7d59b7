#include "convex/nearest_point/sparse/proportioned_gradients.hpp"

#include <doctest/doctest.h>

#include "convex/nearest_point/gallery/gallery.hpp"

using namespace convex;

namespace {

GalleryInstance packing(Index discs) {
  return gallery_instance(*find_family("hexagonal-packing"), discs, 0.5);
}

Accuracy to(double tolerance) {
  Accuracy accuracy;
  accuracy.tolerance = tolerance;
  accuracy.step_limit = 5000;
  return accuracy;
}

}  // namespace

TEST_CASE("gradients with proportioning find the planted answer of a packing to the digits asked for") {
  for (const Index discs : {30, 150, 400})
    for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
      CAPTURE(discs);
      CAPTURE(tolerance);
      const GalleryInstance instance = packing(discs);
      const Solution found = proportioned_gradients(instance.problem, to(tolerance));
      REQUIRE(found.status == Status::solved);
      const double error = instance.problem.A.norm(found.q - instance.solution.hi);
      const double size = std::max(found.acceleration_norm, found.force_norm);
      CHECK(error <= 10 * tolerance * size);  // the estimate looks back on few steps
      CHECK(found.lambda.minCoeff() >= 0);
    }
}

TEST_CASE("gradients take fewer steps from multipliers that are nearly right") {
  const GalleryInstance instance = packing(400);
  const Solution cold = proportioned_gradients(instance.problem, to(1e-8));
  const Solution warm = proportioned_gradients(instance.problem, to(1e-8), cold.lambda);
  REQUIRE(warm.status == Status::solved);
  CHECK(warm.steps < cold.steps / 4);
}

TEST_CASE("two-sided rows have multipliers of either sign under gradients too") {
  // x0 - x1 = 0 and x1 >= 1 from z = (-1, 0): both at 1, and the row of equality pulls.
  RowMatrix U(2, 2);
  U << 1, -1, 0, 1;
  const NearestPointProblem problem{
      Metric::identity(2), Vector{{-1, 0}}, ConstraintRows(SparseRows(U.sparseView())), Vector{{0, 1}}, {0}};
  for (const double sign : {1.0, -1.0}) {
    NearestPointProblem turned = problem;
    turned.U = ConstraintRows(SparseRows((Vector{{sign, 1}}.asDiagonal() * U).sparseView()));
    const Solution found = proportioned_gradients(turned, to(1e-10));
    REQUIRE(found.status == Status::solved);
    CHECK((found.q - Vector{{1, 1}}).norm() <= 1e-9);
    CHECK(found.lambda[0] * sign == doctest::Approx(2));
    CHECK(found.lambda[1] == doctest::Approx(3));
  }
}

TEST_CASE("rows that contradict each other are not called solved") {
  RowMatrix U(2, 1);
  U << 1, -1;
  const NearestPointProblem problem{
      Metric::identity(1), Vector::Zero(1), ConstraintRows(SparseRows(U.sparseView())), Vector{{1, 1}}, {}};
  CHECK(proportioned_gradients(problem, to(1e-6)).status == Status::inaccurate);
}
