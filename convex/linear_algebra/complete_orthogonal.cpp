#include "convex/linear_algebra/complete_orthogonal.hpp"

#include <Eigen/QR>

namespace convex::linear_algebra {

using Decomposition = Eigen::CompleteOrthogonalDecomposition<Matrix>;

CompleteOrthogonal::CompleteOrthogonal(const Matrix& V) : factor_(std::make_unique<const Decomposition>(V)) {}

CompleteOrthogonal::CompleteOrthogonal(const Matrix& V, double threshold) {
  auto factor = std::make_unique<Decomposition>();
  factor->setThreshold(threshold);
  factor->compute(V);
  factor_ = std::move(factor);
}

CompleteOrthogonal::~CompleteOrthogonal() = default;

Vector CompleteOrthogonal::solve(const Vector& b) const { return factor_->solve(b); }

Matrix CompleteOrthogonal::solve_columns(const Matrix& B) const { return factor_->solve(B); }

Matrix CompleteOrthogonal::pseudo_inverse() const {
  return solve_columns(Matrix::Identity(factor_->rows(), factor_->rows()));
}

}  // namespace convex::linear_algebra
