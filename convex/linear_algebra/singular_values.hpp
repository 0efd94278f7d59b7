#pragma once

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// Z = U diag(sigma) Vᵀ of an m×n matrix, with k = min(m, n) columns in U and V; sigma decreases. By
/// rotations (Jacobi), where Z is large of Z times the eigenvectors of ZᵀZ.
struct SingularValues {
  explicit SingularValues(const Matrix& Z);

  Matrix U, V;
  Vector sigma;
};

/// The singular values, in decreasing order.
Vector singular_values(const Matrix& Z);

}  // namespace convex::linear_algebra
