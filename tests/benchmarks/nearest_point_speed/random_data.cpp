#include "random_data.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace speed {

Vector RandomData::normals(Index n) {
  return Vector::NullaryExpr(n, [&] { return normal(); });
}

Vector RandomData::dyadic_row(Index n) {
  return Vector::NullaryExpr(n, [&] { return integer(-8, 8) / 16.0; });
}

Vector RandomData::dyadic_point(Index n) {
  return Vector::NullaryExpr(n, [&] { return integer(-32, 32) / 16.0; });
}

RowMatrix RandomData::unit_rows(Index m, Index n) {
  return RowMatrix(RowMatrix::NullaryExpr(m, n, [&] { return normal(); })).rowwise().normalized();
}

Matrix RandomData::positive_definite(Index n) {
  const Matrix gaussian = Matrix::NullaryExpr(n, n, [&] { return normal(); });
  const Matrix Q = Eigen::HouseholderQR<Matrix>(gaussian).householderQ();
  const Vector eigenvalues =
      Vector::LinSpaced(n, -1, 1).unaryExpr([](double exponent) { return std::pow(10.0, exponent); });
  const Matrix A = Q * eigenvalues.asDiagonal() * Q.transpose();
  return (A + A.transpose()) / 2;
}

std::vector<Index> RandomData::shuffled(Index count) {
  std::vector<Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), Index{0});
  std::shuffle(order.begin(), order.end(), generator_);
  return order;
}

}  // namespace speed
