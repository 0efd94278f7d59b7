#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"

using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Status;
using convex::Vector;

namespace {

/// The answer with its residuals found anew.
Solution judged(const NearestPointProblem& problem, Solution answer) {
  answer.slack = problem.U.times(answer.q) - problem.s;
  answer.acceleration_norm = problem.A.norm(answer.q);
  answer.residuals = convex::residuals(problem, answer.q, answer.lambda);
  return answer;
}

}  // namespace

TEST_CASE("the gap of a point that satisfies all rows bounds its distance to the nearest point") {
  std::mt19937 draw(1966);
  std::uniform_real_distribution<double> number(-1, 1);
  int bounded = 0;
  for (int round = 0; round < 300; ++round) {
    const Index n = 2 + round % 4, m = n + 2;
    const Matrix root = Matrix::NullaryExpr(n, n, [&] { return number(draw); });
    const Matrix A = root.transpose() * root + 0.1 * Matrix::Identity(n, n);
    // Rows of directions that all agree with (1, ..., 1), along which the point is moved inwards.
    RowMatrix U = RowMatrix::NullaryExpr(m, n, [&] { return number(draw); });
    for (Index a = 0; a < m; ++a)
      if (U.row(a).sum() < 0) U.row(a) *= -1;
    const NearestPointProblem problem{Metric::dense(A),
                                      Vector::NullaryExpr(n, [&] { return number(draw); }),
                                      convex::ConstraintRows(U),
                                      Vector::NullaryExpr(m, [&] { return number(draw); }),
                                      {}};
    const Solution exact = convex::automatic(problem, {});
    if (exact.status != Status::solved) continue;
    for (const double step : {0.0, 1e-12, 1e-6, 1e-2}) {
      Solution moved = exact;
      moved.q += Vector::Constant(n, step);
      moved.lambda *= 1 + step;
      moved = judged(problem, moved);
      const double bound = convex::bound_by_gap(problem, moved);
      bounded += std::isfinite(bound) ? 1 : 0;
      CHECK(problem.A.norm(moved.q - exact.q) <= bound + exact.error_bound);
      if (step == 0 || !std::isfinite(bound)) continue;
      moved.q = exact.q - Vector::Constant(n, step);
      if (!exact.basis.empty() && exact.lambda.maxCoeff() > 0)
        CHECK(std::isinf(convex::bound_by_gap(problem, judged(problem, moved))));
    }
  }
  CHECK(bounded > 300);
}

TEST_CASE("an answer that is right whatever rows say of each other needs no fractions") {
  // A membrane over obstacles, and sums of these rounded: they contradict or leave room by rounding alone.
  std::mt19937 draw(1966);
  std::uniform_real_distribution<double> height(-0.1, 0.1);
  constexpr Index side = 6, n = side * side;
  Matrix A = 4.000001 * Matrix::Identity(n, n);
  for (Index i = 0; i < n; ++i) {
    if ((i + 1) % side != 0) A(i, i + 1) = A(i + 1, i) = -1;
    if (i + side < n) A(i, i + side) = A(i + side, i) = -1;
  }
  for (int round = 0; round < 20; ++round) {
    RowMatrix U = RowMatrix::Zero(n + side, n);
    Vector s(n + side);
    for (Index i = 0; i < n; ++i) {
      U(i, i) = 1;
      s[i] = height(draw);
    }
    for (Index k = 0; k < side; ++k) {
      U(n + k, k * side) = U(n + k, k * side + 1) = 1;
      s[n + k] = s[k * side] + s[k * side + 1];
    }
    const NearestPointProblem problem{
        Metric::dense(A), Vector::Constant(n, -0.01), convex::ConstraintRows(U), s, {}};
    constexpr double hardly_any = 1e-12;
    const Solution found = convex::automatic(problem, {.limit = hardly_any}),
                   exact = convex::automatic(problem, {});
    REQUIRE(exact.status == Status::solved);
    CHECK(found.status == Status::solved);
    CHECK(problem.A.norm(found.q - exact.q) <= found.error_bound + exact.error_bound);
  }
}
