#pragma once

#include <random>

#include "convex/nearest_point/problem.hpp"

namespace oracles {

/// A feasible problem whose doubles use all their digits: nothing in it is exactly tied.
inline convex::NearestPointProblem full_mantissa(unsigned seed, convex::Index n, convex::Index m) {
  using convex::Matrix;
  using convex::RowMatrix;
  using convex::Vector;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const auto random = [&](double) { return normal(generator); };
  const Matrix G = Matrix::Zero(n, n).unaryExpr(random);
  const Matrix A = G * G.transpose() + Matrix::Identity(n, n);
  const RowMatrix U = RowMatrix::Zero(m, n).unaryExpr(random);
  const Vector inside = Vector::Zero(n).unaryExpr(random), gap = Vector::Zero(m).unaryExpr(random);
  return {convex::Metric::dense(0.5 * (A + A.transpose())),
          5 * Vector::Zero(n).unaryExpr(random),
          convex::ConstraintRows(U),
          U * inside - gap.cwiseAbs(),
          {}};
}

}  // namespace oracles
