#include "convex/linear_algebra/pivoted_qr.hpp"

#include <Eigen/QR>

namespace convex::linear_algebra {

PivotedQr::PivotedQr(const Matrix& V) {
  const Eigen::ColPivHouseholderQR<Matrix> factor(V);
  const auto& columns = factor.colsPermutation().indices();
  order.assign(columns.data(), columns.data() + columns.size());
  pivots = factor.matrixQR().diagonal().cwiseAbs();
  rank = factor.rank();
}

Vector least_squares(const Matrix& V, const Vector& b) {
  return Eigen::ColPivHouseholderQR<Matrix>(V).solve(b);
}

}  // namespace convex::linear_algebra
