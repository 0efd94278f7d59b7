#include <doctest/doctest.h>

#include <string>

#include "convex/nearest_point/methods.hpp"
#include "tests/oracles/nearest_point_error.hpp"

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Status;
using convex::Vector;
using oracles::few_roundings;

namespace {

/// Rows that are opposite to others but for 2⁻⁴⁵: what they leave lies 1e14 away, with multipliers of 1e28,
/// whose rounding is larger than many others.
NearestPointProblem opposite_to_a_two_sided_row() {
  Matrix A(5, 5);
  A << 2, 2, 1, 2, 2, 2, 14, 3, 6, 8, 1, 3, 8, 0, 3, 2, 6, 0, 10, 6, 2, 8, 3, 6, 11;
  RowMatrix U(5, 5);
  U << 0, 1, -1, 1, -2, 1, 2, 0, 0, -2, 0, 1, -1, 1, -2, 1, 1, -1, 2, -1, 0, -1, 1, 0x1p-45 - 1, 2;
  Vector z(5), s(5);
  z << -3, -3, 3, 1, 0;
  s << 2, -2, 2, 0, 2;
  return {convex::Metric::dense(A), z, convex::ConstraintRows(U), s, {0, 1}};
}

NearestPointProblem five_rows_nearly_one() {
  Matrix A(5, 5);
  A << 14, -10, -4, 2, -11, -10, 12, 5, -1, 10, -4, 5, 7, 2, 7, 2, -1, 2, 5, 1, -11, 10, 7, 1, 15;
  const double off = 0x1p-40;
  RowMatrix U(8, 5);
  U << -1, -1, -1, 0, -1, -1, 1, 1, -1, -1, 2, 1, 0, -1, 1, 0, 0, 0, 0, 1, 1, -1, -1 - off, 1, 1, -1,
      1 + off / 4, 1 + off, -1, -1, -1, 1, 1 + off, -1, -1, -1, 1, 1, 0x1p-26 - 1, -1;
  Vector z(5), s(8);
  z << 0, 192, -64, 0, 0;
  s << -128, 0, 0, 64, 64, 0, -64, 0;
  return {convex::Metric::dense(A), z, convex::ConstraintRows(U), s, {}};
}

/// q* = 0 between two rows that are opposite but for 1e-5 of their lengths where masses differ by 4e9: their
/// multipliers, times their lengths, are 4e4 times as large as what they hold.
NearestPointProblem at_rest_between_nearly_opposite_rows() {
  Matrix A(2, 2);
  A << 1610612736, 0, 0, 0.375;
  RowMatrix U(2, 2);
  U << -1, 2, -1, -1;
  Vector z(2);
  z << 5, 0;
  return {convex::Metric::dense(A), z, convex::ConstraintRows(U), Vector::Zero(2), {}};
}

/// y >= -1 and -(1 - 2⁻⁴⁴) y >= 1 - 2⁻⁵² contradict each other by 6e-14; a third row keeps the point 1.7e15
/// away.
NearestPointProblem contradiction_far_away() {
  Matrix A(2, 2);
  A << 4, 3, 3, 7;
  RowMatrix U(3, 2);
  U << 0x1p-49, 0x1p-42, 0, 1, 0, 0x1p-44 - 1;
  Vector z(2), s(3);
  z << -7, -1;
  s << 3 - 0x1p-22, -1, 1 - 0x1p-52;
  return {convex::Metric::dense(A), z, convex::ConstraintRows(U), s, {}};
}

}  // namespace

TEST_CASE(
    "the bound of a point between nearly opposite rows counts the rounding of multipliers that cancel") {
  const NearestPointProblem problem = at_rest_between_nearly_opposite_rows();
  for (const convex::Method& method : convex::methods()) {
    if (!method.applies(problem).empty()) continue;
    CAPTURE(std::string(method.name));
    const Solution found = method.solve(problem, {});
    if (found.status != Status::solved) continue;
    CHECK(problem.A.norm(found.q) <= found.error_bound);
  }
}

TEST_CASE("rows that contradict each other by less than the rounding of a far point are never solved") {
  const NearestPointProblem problem = contradiction_far_away();
  CHECK(convex::find_method("auto")->solve(problem, {}).status == Status::infeasible);
  for (const convex::Method& method : convex::methods()) {
    if (!method.applies(problem).empty()) continue;
    CAPTURE(std::string(method.name));
    CHECK(method.solve(problem, {}).status != Status::solved);
  }
}

TEST_CASE("where nothing pulls, rows that disagree by less than their radii are no contradiction") {
  const double k = -0.1191139186822877;  // a row written twice, the second time by exp
  RowMatrix U(2, 2);
  U << 2, 0.3, 2 * k, 0.3 * k;
  NearestPointProblem problem{convex::Metric::dense(Matrix::Identity(2, 2)),
                              Vector::Zero(2),
                              convex::ConstraintRows(U),
                              Vector(2),
                              {1}};
  problem.s << 0, 0x1p-54;
  problem.radii = convex::DataRadii{Vector::Constant(2, 0x1p-52), Vector::Constant(2, 0x1p-52)};
  CHECK(convex::find_method("auto")->solve(problem, {}).status != Status::infeasible);
  problem.s << 0, 0x1p-40;
  CHECK(convex::find_method("auto")->solve(problem, {}).status == Status::infeasible);
}

TEST_CASE("rows that a turn within their radii makes meet, however far away, are no contradiction") {
  // x >= 0 and -x + e y >= 1e-13 with e up to the radius of a row: the rows meet at y = 1e-13 / e, here 450.
  const double radius = 0x1p-53, gap = 1e-13;
  RowMatrix U(2, 2);
  U << 1, 0, -1, 0;
  NearestPointProblem problem{
      convex::Metric::identity(2), Vector{{-10, 0}}, convex::ConstraintRows(U), Vector{{0, gap}}, {}};
  problem.radii = convex::DataRadii{Vector::Constant(2, radius), Vector::Zero(2)};
  for (const char* method : {"auto", "active-set", "nnls", "lemke"}) {
    CAPTURE(std::string(method));
    const Solution found = convex::find_method(method)->solve(problem, {});
    CHECK(found.status == Status::solved);
    CHECK(std::abs(found.q[0]) <= gap);
  }
  CHECK_FALSE(convex::find_method("auto")->solve(problem, {}).undecided.empty());
  problem.s[1] = 1e-10;  // nothing within the scale of the problem
  CHECK(convex::find_method("auto")->solve(problem, {}).status == Status::infeasible);
}

TEST_CASE("where rows meet far away at a small angle, no method calls solved what is not") {
  for (const NearestPointProblem& problem : {opposite_to_a_two_sided_row(), five_rows_nearly_one()}) {
    const Solution truth = convex::find_method("exact")->solve(problem, {});
    REQUIRE(truth.status == Status::solved);
    for (const convex::Method& method : convex::methods()) {
      if (!method.applies(problem).empty()) continue;
      CAPTURE(std::string(method.name));
      const Solution found = method.solve(problem, {});
      CHECK(found.status != Status::infeasible);
      if (found.status != Status::solved) continue;
      const double error = problem.A.norm(found.q - truth.q);
      CHECK(error <= found.error_bound + few_roundings * oracles::scale(problem, truth.q));
    }
  }
}

TEST_CASE("a third row of two coordinates depends on the two held, however much longer it is") {
  // Rows of lengths 5e-13, 1/3 and 6e149: what rounding leaves of the third was taken for a third direction.
  RowMatrix U(3, 2);
  U << 5e-13, 1e-13, -0.3333333333333333, 0.03333333333336667, 6.370365454394964e+149, 5.276541048224815e+148;
  const NearestPointProblem problem{convex::Metric::diagonal(Vector{{64, 8192}}),
                                    Vector::Zero(2),
                                    convex::ConstraintRows(U),
                                    Vector{{-1.5e-13, 0.19999999999999998, -2.6575286223750004e+149}},
                                    {0, 1, 2}};
  REQUIRE(convex::find_method("exact")->solve(problem, {}).status == Status::infeasible);
  for (const char* method : {"auto", "active-set", "enumerate"}) {
    CAPTURE(std::string(method));
    CHECK(convex::find_method(method)->solve(problem, {}).status == Status::infeasible);
  }
}

TEST_CASE("the unit in which a row is written again does not enter the error bound") {
  // sqrt(x² + y²) = l and (x² + y²)³ = l⁶ at l = 1e6; and the other way round, at l = 1e-6.
  for (const double unit : {6e30, 6e-30}) {
    CAPTURE(unit);
    RowMatrix U(2, 2);
    U << 0.8414709848078965, -0.5403023058681397, 0.8414709848078966 * unit, -0.5403023058681398 * unit;
    NearestPointProblem problem{
        convex::Metric::identity(2), Vector{{0, -9.81}}, convex::ConstraintRows(U), Vector::Zero(2), {0, 1}};
    problem.radii = convex::DataRadii{Vector{{0x1p-52, 0x1p-52 * unit}}, Vector::Zero(2)};
    for (const char* method : {"auto", "active-set"}) {
      CAPTURE(std::string(method));
      const Solution found = convex::find_method(method)->solve(problem, {});
      CHECK(found.status == Status::solved);
      CHECK(found.error_bound <= 1e-13);
    }
  }
}
