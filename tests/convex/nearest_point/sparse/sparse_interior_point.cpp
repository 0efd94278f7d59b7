#include "convex/nearest_point/sparse/sparse_interior_point.hpp"

#include <doctest/doctest.h>

#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/sparse/sparse_active_set.hpp"

using namespace convex;

namespace {

GalleryInstance discs(Index count) { return gallery_instance(*find_family("hexagonal-packing"), count, 0.5); }

Accuracy digits(double tolerance) {
  Accuracy accuracy;
  accuracy.tolerance = tolerance;
  return accuracy;
}

/// Each entry of x changed by this part of the largest, one way or the other.
Vector shaken(Vector x, double part) {
  const double by = part * x.cwiseAbs().maxCoeff();
  for (Index i = 0; i < x.size(); ++i) x[i] += (7 * i % 5 < 2 ? by : -by);
  return x;
}

}  // namespace

TEST_CASE("an interior point is as near as it is asked to be, and says how near") {
  const GalleryInstance instance = discs(400);
  Index last = 0;
  for (const double tolerance : {1e-2, 1e-5, 1e-8}) {
    const Solution found = sparse_interior_point(instance.problem, digits(tolerance));
    REQUIRE(found.status == Status::solved);
    CHECK(instance.problem.A.norm(found.q - instance.solution.hi) <= found.error_bound);
    CHECK(found.steps >= last);
    last = found.steps;
  }
}

TEST_CASE("what solved a problem like it leads to the same answer in fewer steps") {
  const GalleryInstance instance = discs(400);
  const Solution before = sparse_interior_point(instance.problem, digits(1e-8));
  for (const double part : {1e-8, 1e-5, 1e-3}) {
    CAPTURE(part);
    NearestPointProblem moved = instance.problem;
    moved.z = shaken(moved.z, part);
    const Solution cold = sparse_interior_point(moved, digits(1e-8)),
                   warm = sparse_interior_point(moved, digits(1e-8), before);
    const Solution truth = sparse_active_set(moved);
    REQUIRE(truth.status == Status::solved);
    REQUIRE(warm.status == Status::solved);
    CHECK(moved.A.norm(warm.q - truth.q) <= warm.error_bound + truth.error_bound);
    CHECK(warm.lambda.minCoeff() >= 0);
    CHECK(warm.steps < cold.steps);
  }
}

TEST_CASE("a guess that is far from the answer does no harm") {
  const GalleryInstance instance = discs(150);
  const Index n = instance.problem.dimension(), m = instance.problem.rows();
  const double size = instance.solution.hi.cwiseAbs().maxCoeff();
  for (const double far : {0.0, 1e-6, 1.0, 1e6}) {
    CAPTURE(far);
    Solution guess;
    guess.q = shaken(Vector::Constant(n, far * size), 0.5);
    guess.lambda = shaken(Vector::Constant(m, far * size), 2);  // of both signs
    const Solution found = sparse_interior_point(instance.problem, digits(1e-8), guess);
    REQUIRE(found.status == Status::solved);
    CHECK(instance.problem.A.norm(found.q - instance.solution.hi) <= found.error_bound);
  }
}

TEST_CASE("no guess makes rows that contradict each other solved") {
  RowMatrix U(2, 1);
  U << 1, -1;
  const NearestPointProblem problem{
      Metric::identity(1), Vector::Zero(1), ConstraintRows(SparseRows(U.sparseView())), Vector{{1, 1}}, {}};
  Solution guess;
  for (const double push : {0.0, 1.0, 1e9}) {
    guess.q = Vector{{0}};
    guess.lambda = Vector{{push, push}};
    CHECK(sparse_interior_point(problem, digits(1e-6), guess).status != Status::solved);
  }
}

TEST_CASE("an active set that may take few steps ends with the answer or with none") {
  const GalleryInstance instance = discs(400);
  const Solution whole = sparse_active_set(instance.problem);
  Accuracy few;
  for (few.step_limit = 1; few.step_limit < 40; few.step_limit += 3) {
    CAPTURE(few.step_limit);
    const Solution found = sparse_active_set(instance.problem, few, {0, 1, 2});
    if (found.status == Status::solved)
      CHECK(instance.problem.A.norm(found.q - instance.solution.hi) <= found.error_bound + whole.error_bound);
    else
      CHECK(found.status == Status::gave_up);
  }
}
