#include "convex/nearest_point/optimality/exact_slack.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <array>
#include <optional>
#include <vector>

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

TEST_CASE(
    "of rows side by side those that are sums of others, whole or in fractions, have a slack there alone") {
  convex::RowMatrix U(7, 3);
  U << 1, 0.5, 0, 0, 1, 0.25,        // held
      2, 0, -0.25,                   // twice the first less the second
      0.5, 0.75, 0.125,              // half of both
      1, 1.5, 0.25 + 0x1p-30,        // no sum of them, by one bit
      0, 1, 0.25, 0x1p-10, 1, 0.25;  // the second again, and none
  convex::NearestPointProblem problem{convex::Metric::identity(3),
                                      Vector::Zero(3),
                                      convex::ConstraintRows(U),
                                      Vector{{1, 2, -1, 1, 3, 2, 2}},
                                      {}};
  const Vector row_scale = U.rowwise().norm();
  const std::array<Index, 2> held{0, 1};
  const std::array<Index, 5> rows{2, 3, 4, 5, 6};
  std::vector<double> X(24, 0), coefficients(16, 0);
  const convex::Matrix exact =
      (U.topRows(2) * U.topRows(2).transpose()).inverse() * U.topRows(2) * U.bottomRows(5).transpose();
  for (Index l = 0; l < 5; ++l) {
    for (Index i = 0; i < 3; ++i) X[static_cast<std::size_t>(8 * i + l)] = U(2 + l, i);
    for (Index k = 0; k < 2; ++k) coefficients[static_cast<std::size_t>(8 * k + l)] = exact(k, l);
  }
  for (const double finer : {0.0, 0x1p-60}) {
    problem.s[2] = -1 + (finer > 0 ? 1 : 0), problem.s[1] = 2 + (finer > 0 ? -2 : 0);
    problem.s[0] = finer > 0 ? finer : 1;
    convex::SlackOnEdge edge(problem, row_scale.data());
    edge.begin();
    std::array<std::optional<double>, 8> slack;
    edge.slacks(rows, X.data(), held.data(), 2, coefficients.data(), slack.data());
    const double s0 = problem.s[0], s1 = problem.s[1];
    CHECK(slack[0] == 2 * s0 - s1 - problem.s[2]);
    CHECK(slack[1] == (s0 + s1 - 2 * problem.s[3]) / 2);
    CHECK(!slack[2]);
    CHECK(slack[3] == s1 - problem.s[5]);
    CHECK(!slack[4]);
  }
}
