#include "mechanics/vertex.hpp"

#include <doctest/doctest.h>

#include "mechanics/gauss_laws.hpp"

using convex::ConstraintRows;
using convex::Matrix;
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

TEST_CASE("a row that asks for more than the others by a few hundred roundings is no row to spare") {
  const NearestPointProblem almost = problem(RowMatrix{{1}, {0.5000000000000284}}, Vector{{3, 1.5}});
  const auto vertex = mechanics::vertex_acceleration(almost);
  CHECK((!vertex || (*vertex)[0] == 3));
  CHECK(mechanics::gauss_laws(almost, mechanics::solve(almost)).all_passed());
}

TEST_CASE("right answers pass where rows are almost opposite, or the vertex is far beside the acceleration") {
  const NearestPointProblem scenes[] = {
      {Metric::dense(Matrix{{5, 4}, {4, 5}}),
       Vector{{-9, 3}},
       ConstraintRows(RowMatrix{{3, 0}, {-3.000000000001819, 0}}),
       Vector{{0, -5e-324}},
       {}},
      {Metric::dense(Matrix{{15, 2, -4}, {2, 12, 1}, {-4, 1, 12}}),
       Vector::Zero(3),
       ConstraintRows(RowMatrix{{-3, 3, 3}, {-3, 3, 3}, {-1, -1, 3}}),
       Vector{{0, 0x1p-30, -1}},
       {}},
      {Metric::dense(Matrix{{6, -9}, {-9, 19}}),
       Vector::Zero(2),
       ConstraintRows(RowMatrix{{1, -1}, {2.9999999999999973, -3}, {-3, 1}}),
       Vector{{-3, -9, 0}},
       {2}},
      {Metric::diagonal(Vector{{1, 11}}),
       Vector::Zero(2),
       ConstraintRows(RowMatrix{{-1, 3}, {-0.5, 1.5}, {-2, 1}, {-6, 3}}),
       Vector{{-3, -1.5, 0, 0x1p-45}},
       {}}};
  for (const NearestPointProblem& scene : scenes) {
    const mechanics::GaussSolution solution = mechanics::solve(scene);
    CAPTURE(solution.primal.q.transpose());
    CHECK(solution.primal.status == convex::Status::solved);
    const convex::LawReport report = mechanics::gauss_laws(scene, solution);
    CHECK(report.all_passed());
    bool split = false;
    for (const convex::Check& check : report.checks) split = split || check.name.rfind("z = x + y", 0) == 0;
    CHECK(split);
  }
}

TEST_CASE("multipliers of rows that are parallel but for 200 roundings balance, and the reaction with them") {
  const NearestPointProblem scene{
      Metric::dense(Matrix{{14, 5, 3}, {5, 18, -7}, {3, -7, 12}}),
      Vector{{-2, -3, 7}},
      ConstraintRows(RowMatrix{{0, 2, 2}, {0, 2.000000000000057, 2}, {0, 2.000000000000057, 2}}),
      Vector::Ones(3),
      {0, 1}};
  const mechanics::GaussSolution solution = mechanics::solve(scene);
  CHECK((solution.reaction - Vector{{0, -1.75, -1.75}}).norm() <=
        1e-15);  // by fractions, lambda = (-7/8, 0, 0)
  CHECK((solution.multipliers.least_norm - Vector{{-0.875, 0, 0}}).norm() <= 1e-15);
  CHECK(mechanics::gauss_laws(scene, solution).all_passed());
}
