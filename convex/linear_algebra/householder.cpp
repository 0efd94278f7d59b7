#include "convex/linear_algebra/householder.hpp"

#include <Eigen/QR>

namespace convex::linear_algebra {

Householder::Householder(const Matrix& V) {
  const Eigen::HouseholderQR<Matrix> factor(V);
  reflections_ = factor.matrixQR();
  coefficients_ = factor.hCoeffs();
}

Matrix Householder::Q(Index columns) const {
  return Eigen::householderSequence(reflections_, coefficients_) *
         Matrix::Identity(reflections_.rows(), columns);
}

Matrix Householder::R() const {
  return reflections_.topRows(reflections_.cols()).triangularView<Eigen::Upper>();
}

void Householder::solve_R_in_place(Matrix& X) const {
  reflections_.topRows(reflections_.cols()).triangularView<Eigen::Upper>().solveInPlace(X);
}

Matrix Householder::least_squares(const Matrix& B) const {
  Matrix all = B;
  all.applyOnTheLeft(
      Eigen::householderSequence(reflections_, coefficients_).setLength(reflections_.cols()).adjoint());
  Matrix X = all.topRows(reflections_.cols());
  solve_R_in_place(X);
  return X;
}

}  // namespace convex::linear_algebra
