#include "convex/nearest_point/optimality/refinement.hpp"

#include <doctest/doctest.h>

#include <random>

using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Vector;

namespace {

/// Small integers in A, U, q and lambda make z and s exact: the point of the first `held` rows is known.
struct Planted {
  NearestPointProblem problem;
  Vector q, lambda;
};

Planted planted(Index n, Index held, double softest, std::mt19937& draw) {
  std::uniform_int_distribution<int> digit(-3, 3);
  const auto integer = [&] { return static_cast<double>(digit(draw)); };
  Matrix root = Matrix::NullaryExpr(n, n, integer);
  root.diagonal().array() += 8;
  root.col(0) = root.col(1);  // singular but for what the diagonal adds
  const Matrix A = root.transpose() * root + softest * Matrix::Identity(n, n);
  RowMatrix U = RowMatrix::NullaryExpr(held, n, integer);
  for (Index a = 0; a < held; ++a) U(a, a) += 7;
  Vector q = Vector::NullaryExpr(n, integer), lambda = Vector::NullaryExpr(held, integer);
  const Vector z = A * q - U.transpose() * lambda, s = U * q;
  return {{Metric::dense(A), z, convex::ConstraintRows(U), s, {}}, q, lambda};
}

convex::WorkingSet holding_all(const NearestPointProblem& problem) {
  convex::WorkingSet set(problem);
  convex::WorkingSet::Split split;
  for (Index p = 0; p < problem.rows(); ++p) {
    set.split(p, split);
    set.append(p, split, 0);
  }
  set.solve();
  return set;
}

}  // namespace

TEST_CASE("refinement finds all digits of the point of a working set of which doubles find half") {
  std::mt19937 draw(1966);
  int far = 0;
  for (int round = 0; round < 60; ++round) {
    const Index n = 3 + round % 6;
    const Planted at = planted(n, n - 2, 0x1p-26, draw);
    const convex::WorkingSet set = holding_all(at.problem);
    const convex::RefinedPoint refined = convex::refine(set);
    far += (set.point() - at.q).cwiseAbs().maxCoeff() > 1e-12;
    CHECK(refined.q.hi == at.q);
    CHECK(refined.lambda.hi == at.lambda);
    CHECK(at.problem.A.norm(refined.q.lo) <= 1e-24 * set.scale());
    CHECK(refined.remaining() <= convex::enough * set.scale());
  }
  CHECK(far >= 20);
}

TEST_CASE("what refinement says is missing is no less than what is") {
  std::mt19937 draw(1964);
  for (int round = 0; round < 60; ++round) {
    const Index n = 3 + round % 4;
    const Planted at = planted(n, n - 1, 0x1p-40, draw);
    const convex::RefinedPoint refined = convex::refine(holding_all(at.problem));
    const double missing = at.problem.A.norm((refined.q.hi - at.q) + refined.q.lo);
    CHECK(missing <= refined.remaining() + refined.dropped);
  }
}

TEST_CASE("the multiplier that is most negative is that of the row that pulls hardest for its length") {
  const NearestPointProblem problem{Metric::identity(3),
                                    Vector{{-2, 3, 5}},
                                    convex::ConstraintRows(RowMatrix{{1, 0, 0}, {0, 1, 0}, {0, 0, 8}}),
                                    Vector::Zero(3),
                                    {}};
  const convex::WorkingSet set = holding_all(problem);  // lambda = (2, -3, -5/8), times lengths 2, -3, -5
  CHECK(convex::most_negative(set, convex::refine(set)) == 2);
}
