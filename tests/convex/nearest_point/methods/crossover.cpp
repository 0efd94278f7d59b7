#include "convex/nearest_point/methods/crossover.hpp"

#include <doctest/doctest.h>

#include <random>

using convex::Candidate;
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Status;
using convex::Vector;

namespace {

/// Half of the rows hold with multipliers from 1 to 4, the others are clear of theirs by 1 or more; all
/// exact.
struct Planted {
  NearestPointProblem problem;
  Vector q, lambda;
};

Planted planted(Index n, std::mt19937& draw) {
  std::uniform_int_distribution<int> digit(-3, 3), size(1, 4);
  const auto integer = [&] { return static_cast<double>(digit(draw)); };
  Matrix root = Matrix::NullaryExpr(n, n, integer);
  root.diagonal().array() += 9;
  const Matrix A = root.transpose() * root;
  RowMatrix U = RowMatrix::NullaryExpr(n, n, integer);
  U.diagonal().array() += 8;
  Vector q = Vector::NullaryExpr(n, integer), lambda = Vector::Zero(n), s = U * q;
  for (Index a = 0; a < n; ++a)
    if (a % 2 == 0)
      lambda[a] = size(draw);
    else
      s[a] -= size(draw);
  const Vector z = A * q - U.transpose() * lambda;
  return {{Metric::dense(A), z, convex::ConstraintRows(U), s, {}}, q, lambda};
}

Candidate near(const Planted& truth, double off, std::mt19937& draw) {
  std::normal_distribution<double> normal;
  const auto noise = [&] { return off * normal(draw); };
  Candidate found{.method = "a guess", .q = truth.q, .lambda = truth.lambda, .farkas = {}};
  found.q += Vector::NullaryExpr(found.q.size(), noise);
  for (double& x : found.lambda)
    if (x > 0) x += noise();
  return found;
}

}  // namespace

TEST_CASE("of a candidate that shows which rows are active crossover makes the nearest point") {
  std::mt19937 draw(1966);
  for (int round = 0; round < 50; ++round) {
    const Planted truth = planted(2 + round % 9, draw);
    const Solution found = convex::crossover(truth.problem, near(truth, 1e-5, draw), {});
    REQUIRE(found.status == Status::solved);
    CHECK(found.polished);
    CHECK(found.q == truth.q);
    CHECK(found.lambda == truth.lambda);
  }
}

TEST_CASE("a candidate that must stay as it is has a bound above its distance to the nearest point") {
  std::mt19937 draw(1965);
  for (int round = 0; round < 50; ++round) {
    const Planted truth = planted(2 + round % 9, draw);
    Candidate candidate = near(truth, 1e-5, draw);
    candidate.may_polish = false;
    const Solution found = convex::crossover(truth.problem, candidate, {});
    const double distance = truth.problem.A.norm(candidate.q - truth.q);
    CHECK(found.q == candidate.q);
    CHECK(found.status == Status::inaccurate);
    CHECK(found.error_bound >= distance);
    CHECK(found.error_bound <= 1.01 * distance);
  }
}

TEST_CASE("weights that prove nothing make no candidate infeasible, and those that do prove it") {
  const NearestPointProblem problem{
      Metric::identity(1), Vector{{0}}, convex::ConstraintRows(RowMatrix{{1}, {-1}}), Vector{{1, 0}}, {}};
  const auto told = [&](const Vector& weights) {
    return convex::crossover(
               problem,
               {.method = "a guess", .q = Vector{{0.5}}, .lambda = Vector::Zero(2), .farkas = weights}, {})
        .status;
  };
  CHECK(told(Vector{{1, 1}}) == Status::infeasible);
  const NearestPointProblem open{
      Metric::identity(1), Vector{{0}}, convex::ConstraintRows(RowMatrix{{1}, {-1}}), Vector{{1, -1}}, {}};
  const Solution found = convex::crossover(
      open, {.method = "a guess", .q = Vector{{1}}, .lambda = Vector{{1, 0}}, .farkas = Vector{{1, 1}}}, {});
  CHECK(found.status == Status::solved);
  CHECK(found.q == Vector{{1}});
}
