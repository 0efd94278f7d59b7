#include "convex/nearest_point/optimality/exact_slack.hpp"

#include <doctest/doctest.h>

#include <array>

using convex::Index;
using convex::Vector;

TEST_CASE("the slack of a sum of rows has its sign, whether sums of the bounds are exact in doubles or not") {
  convex::RowMatrix U(3, 3);
  U << 1, 0.5, 0, 0, 1, 0.25, 1, 1.5, 0.25;  // the last is the sum of the others
  convex::NearestPointProblem problem{
      convex::Metric::identity(3), Vector::Zero(3), convex::ConstraintRows(U), Vector::Zero(3), {}};
  const Vector row_scale = Vector::Ones(3);
  const std::array<Index, 2> held{0, 1};
  const std::array<double, 2> coefficients{1, 1};
  convex::SlackOnEdge edge(problem, row_scale.data());
  const auto slack = [&](double s0, double s1, double s2) {
    problem.s = Vector{{s0, s1, s2}};
    edge.begin();
    return edge.slack(2, held.data(), 2, coefficients.data());
  };
  CHECK(slack(1, 2, 2.5) == 0.5);
  CHECK(slack(1, 2, 3) == 0);
  // 2⁻⁶⁰ - 1 is no double.
  CHECK(slack(0x1p-60, 1, 1) == 0x1p-60);
  CHECK(slack(-0x1p-60, 1, 1) == -0x1p-60);
  CHECK(slack(0, 0, 0) == 0);
}
