#pragma once

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// S = V diag(values) Vᵀ of a symmetric S, n×n, of which the lower triangle is read.
struct SymmetricEigen {
  explicit SymmetricEigen(const Matrix& S);

  Vector values;   ///< in increasing order
  Matrix vectors;  ///< V, orthogonal
  bool found;      ///< false when the iteration did not end, as for an S that is not finite
};

/// The eigenvalues of a symmetric S, of which the lower triangle is read, in increasing order.
Vector eigenvalues(const Matrix& S);

/// The lambda with A v = lambda B v in increasing order, A symmetric and B symmetric positive definite.
Vector generalized_eigenvalues(const Matrix& A, const Matrix& B);

}  // namespace convex::linear_algebra
