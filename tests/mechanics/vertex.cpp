#include "mechanics/vertex.hpp"

#include <doctest/doctest.h>

#include "mechanics/gauss_laws.hpp"

using convex::ConstraintRows;
using convex::Metric;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Vector;

namespace {

NearestPointProblem problem(const RowMatrix& U, const Vector& s, std::vector<convex::Index> two_sided = {}) {
  const convex::Index n = U.cols();
  return {Metric::diagonal(Vector::LinSpaced(n, 1, 2)), Vector::Constant(n, -2), ConstraintRows(U), s,
          std::move(two_sided)};
}

}  // namespace

TEST_CASE("a half-line told twice, once too weakly, has its end for a vertex") {
  const auto vertex = mechanics::vertex_acceleration(problem(RowMatrix{{1}, {1}}, Vector{{0, -1}}));
  REQUIRE(vertex);
  CHECK((*vertex)[0] == doctest::Approx(0));
}

TEST_CASE("a corner keeps its vertex whatever rows are to spare, and however they are written") {
  const NearestPointProblem corner =
      problem(RowMatrix{{1, 0}, {0, 3}, {1, 1}, {2, 0}, {1, 5}}, Vector{{1, 6, -7, 2, 11}});
  const auto vertex = mechanics::vertex_acceleration(corner);
  REQUIRE(vertex);
  CHECK((*vertex - Vector{{1, 2}}).norm() <= 1e-12);
}

TEST_CASE("a slab and a triangle have no vertex of a cone; nor has a corner cut by one more row") {
  CHECK_FALSE(mechanics::vertex_acceleration(problem(RowMatrix{{1}, {-1}}, Vector{{0, -1}})));
  CHECK_FALSE(
      mechanics::vertex_acceleration(problem(RowMatrix{{1, 0}, {0, 1}, {-1, -1}}, Vector{{0, 0, -1}})));
  CHECK_FALSE(mechanics::vertex_acceleration(problem(RowMatrix{{1, 0}, {0, 1}, {1, 1}}, Vector{{0, 0, 1}})));
}

TEST_CASE("a two-sided row makes rows redundant, and is never dropped itself") {
  const auto vertex =
      mechanics::vertex_acceleration(problem(RowMatrix{{1, 0}, {1, 0}, {0, 1}}, Vector{{3, 2, 1}}, {0}));
  REQUIRE(vertex);
  CHECK((*vertex - Vector{{3, 1}}).norm() <= 1e-12);
}

TEST_CASE("the reaction is found by section 5's cone where only redundant contacts contradict each other") {
  const NearestPointProblem corner =
      problem(RowMatrix{{1, 0}, {0, 3}, {1, 1}, {2, 0}}, Vector{{1, 6, -7, 2}});
  const mechanics::GaussSolution solution = mechanics::solve(corner);
  CHECK_FALSE(solution.hypothesis.two_sided.consistent);
  REQUIRE(solution.from_dual);
  CHECK((solution.from_dual->reaction - solution.reaction).norm() <= 1e-12);
  CHECK(mechanics::gauss_laws(corner, solution).all_passed());
}
