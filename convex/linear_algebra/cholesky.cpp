#include "convex/linear_algebra/cholesky.hpp"

#include <Eigen/Cholesky>

namespace convex::linear_algebra {

Cholesky::Cholesky(const Matrix& W) : L_(W), is_definite_(factor_in_place(L_)) {}

Matrix Cholesky::L() const { return L_.triangularView<Eigen::Lower>(); }

Vector Cholesky::solve(const Vector& b) const {
  Vector x = b;
  L_.triangularView<Eigen::Lower>().solveInPlace(x);
  L_.adjoint().triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

Matrix Cholesky::solve_columns(const Matrix& B) const {
  Matrix X = B;
  solve_lower_in_place(X);
  solve_upper_in_place(X);
  return X;
}

void Cholesky::solve_lower_in_place(Matrix& X) const { L_.triangularView<Eigen::Lower>().solveInPlace(X); }

void Cholesky::solve_upper_in_place(Matrix& X) const {
  L_.adjoint().triangularView<Eigen::Upper>().solveInPlace(X);
}

bool factor_in_place(Eigen::Ref<Matrix> W) {
  return Eigen::LLT<Eigen::Ref<Matrix>>(W).info() == Eigen::Success;
}

}  // namespace convex::linear_algebra
