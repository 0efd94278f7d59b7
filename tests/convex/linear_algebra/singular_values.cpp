#include "convex/linear_algebra/singular_values.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace convex;

namespace {

Matrix random_matrix(Index rows, Index cols, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Matrix Z(rows, cols);
  for (Index i = 0; i < Z.size(); ++i) Z.data()[i] = normal(generator);
  return Z;
}

/// Z = U diag(sigma) V^T to rounding, with columns at right angles of length 1 and sigma that decreases.
void check_factors(const Matrix& Z) {
  const linear_algebra::SingularValues of(Z);
  const Index k = std::min(Z.rows(), Z.cols());
  const double rounding = 1e-14 * std::sqrt(static_cast<double>(Z.size()));
  REQUIRE(of.sigma.size() == k);
  CHECK((of.U.transpose() * of.U - Matrix::Identity(k, k)).norm() <= rounding);
  CHECK((of.V.transpose() * of.V - Matrix::Identity(k, k)).norm() <= rounding);
  const double scale = of.sigma.maxCoeff() > 0 ? of.sigma.maxCoeff() : 1;
  CHECK((of.U * (of.sigma / scale).asDiagonal() * of.V.transpose() - Z / scale).norm() <= rounding);
  for (Index i = 1; i < k; ++i) CHECK(of.sigma[i] <= of.sigma[i - 1]);
}

}  // namespace

TEST_CASE("singular values make up a large matrix: tall, wide, of low rank, graded, 0, and far from 1") {
  const Matrix tall = random_matrix(80, 60, 3);
  check_factors(tall);
  check_factors(tall.transpose());
  check_factors(random_matrix(70, 5, 4) * random_matrix(5, 64, 5));
  Matrix graded = tall;
  for (Index j = 0; j < graded.cols(); ++j) graded.col(j) *= std::pow(10.0, -static_cast<double>(j) / 4);
  check_factors(graded);
  check_factors(Matrix::Zero(50, 50));
  check_factors(tall * 1e300);
  check_factors(tall * 1e-300);
}

TEST_CASE("the singular values of a large second difference are known") {
  constexpr Index n = 100;
  Matrix Z = Matrix::Zero(n, n);
  for (Index i = 0; i < n; ++i) {
    Z(i, i) = 2;
    if (i > 0) Z(i, i - 1) = Z(i - 1, i) = -1;
  }
  const Vector sigma = linear_algebra::singular_values(Z);
  for (Index j = 1; j <= n; ++j) {
    const double half = static_cast<double>(j) * std::acos(-1.0) / (2 * (n + 1));
    CHECK(sigma[n - j] == doctest::Approx(4 * std::sin(half) * std::sin(half)).epsilon(1e-11));
  }
}
