#include "tests/convex/linear_quadratic/samples.hpp"

#include <Eigen/QR>
#include <cmath>

#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/sets.hpp"

namespace samples {

namespace lq = convex::linear_quadratic;
using convex::Matrix;
using convex::Vector;

namespace {

Matrix integers(Index rows, Index columns) {
  std::mt19937 generator(7);
  Matrix M(rows, columns);
  for (Index i = 0; i < M.size(); ++i) M.data()[i] = static_cast<double>(generator() % 5) - 2;
  return M;
}

}  // namespace

std::vector<Named> catalogue(Index n) {
  const Matrix A = integers(3, n);
  const Vector one = Vector::Ones(n), b = Vector::Ones(3);
  const Index some = std::max<Index>(1, n / 2);
  Vector breaks(3), lower = -one, upper = one;
  breaks << -1, 0, 2;
  upper[0] = std::numeric_limits<double>::infinity();
  lower[n - 1] = -std::numeric_limits<double>::infinity();
  Matrix pieces(4, 3);
  pieces << std::numeric_limits<double>::infinity(), 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, -2;
  return {{"zero", lq::zero(n)},
          {"linear", lq::linear(one)},
          {"quadratic", lq::quadratic(A.transpose() * A, one)},
          {"squared_norm2", lq::squared_norm2(n, 3)},
          {"norm1", lq::norm1(n, 1)},
          {"norm_inf", lq::norm_inf(n, 2)},
          {"huber", lq::huber(n, 0.5)},
          {"max", lq::max(n)},
          {"sum_largest", lq::sum_largest(n, some)},
          {"max_affine", lq::max_affine(A, b)},
          {"hinge", lq::hinge(n)},
          {"squared_hinge", lq::squared_hinge(n)},
          {"elastic_net", lq::elastic_net(n, 1, 0.5)},
          {"total_variation", lq::total_variation(n, 1)},
          {"pieces", lq::separable_pieces(n, breaks, pieces)},
          {"point", lq::point(one)},
          {"box", lq::box(lower, upper)},
          {"orthant", lq::orthant(n)},
          {"ball1", lq::ball1(n, 1)},
          {"ball_inf", lq::ball_inf(n, 1)},
          {"simplex", lq::simplex(n, 1)},
          {"halfspace", lq::halfspace(one, 1)},
          {"hyperplane", lq::hyperplane(one, 1)},
          {"affine", lq::affine(A.topRows(some > 2 ? 2 : 1), Vector::Zero(some > 2 ? 2 : 1))},
          {"polyhedron", lq::polyhedron(A, b)},
          {"cone", lq::cone(integers(n + 2, n))},
          {"monotone_cone", lq::monotone_cone(n)},
          {"support of a box", lq::support(lq::box(Vector::Zero(n), one))},
          {"support of a polyhedron", lq::support(lq::polyhedron(A, b))}};
}

convex::Metric random_metric(std::mt19937& generator, Index n, double condition) {
  std::normal_distribution<double> normal;
  Matrix B(n, n);
  for (Index i = 0; i < B.size(); ++i) B.data()[i] = normal(generator);
  const Matrix Q = B.householderQr().householderQ();
  Vector d(n);
  for (Index i = 0; i < n; ++i)
    d[i] = std::pow(condition, n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0);
  const Matrix W = Q * d.asDiagonal() * Q.transpose();
  return convex::Metric::dense(0.5 * (W + W.transpose()));
}

Vector tied_point(std::mt19937& generator, Index n, double scale) {
  Vector z(n);
  for (Index i = 0; i < n; ++i) z[i] = scale * (static_cast<double>(generator() % 13) - 6) / 2;
  return z;
}

}  // namespace samples
