#include "convex/linear_algebra/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>

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
  return Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>(A, B, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace convex::linear_algebra
