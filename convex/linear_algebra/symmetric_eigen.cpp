#include "convex/linear_algebra/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>

#include "convex/linear_algebra/cholesky.hpp"

namespace convex::linear_algebra {

SymmetricEigen::SymmetricEigen(const Matrix& S) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(S);
  values = solver.eigenvalues();
  vectors = solver.eigenvectors();
  found = solver.info() == Eigen::Success;
}

Vector eigenvalues(const Matrix& S) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(S, Eigen::EigenvaluesOnly).eigenvalues();
}

Vector generalized_eigenvalues(const Matrix& A, const Matrix& B) {
  const Cholesky factor(B);
  Matrix X = A;
  factor.solve_lower_in_place(X);
  X.transposeInPlace();
  factor.solve_lower_in_place(X);  // L⁻¹A L⁻ᵀ
  return eigenvalues(X);
}

}  // namespace convex::linear_algebra
