#pragma once

#include <memory>

#include "convex/vector.hpp"

namespace Eigen {
template <typename MatrixType>
class CompleteOrthogonalDecomposition;
}

namespace convex::linear_algebra {

/// V = Q [T 0; 0 0] Z of any matrix, m×n, Q and Z orthogonal and T a triangle of the size of the rank: what
/// least squares of least norm need (Eigen's CompleteOrthogonalDecomposition).
class CompleteOrthogonal {
 public:
  explicit CompleteOrthogonal(const Matrix& V);
  /// Pivots up to this part of the largest count as 0.
  CompleteOrthogonal(const Matrix& V, double threshold);
  ~CompleteOrthogonal();

  /// V⁺b, the shortest of the x of least |Vx - b|.
  Vector solve(const Vector& b) const;
  Matrix solve_columns(const Matrix& B) const;
  Matrix pseudo_inverse() const;

 private:
  std::unique_ptr<const Eigen::CompleteOrthogonalDecomposition<Matrix>> factor_;
};

}  // namespace convex::linear_algebra
