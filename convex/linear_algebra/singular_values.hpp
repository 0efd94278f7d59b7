#pragma once

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// Z = U diag(sigma) Vᵀ of an m×n matrix, with k = min(m, n) columns in U and V; sigma decreases. By
/// rotations where Z is small, which gives the small values the most digits, else by divide and conquer.
struct SingularValues {
  explicit SingularValues(const Matrix& Z);

  Matrix U, V;
  Vector sigma;
};

/// The singular values by rotations (one-sided Jacobi), in decreasing order.
Vector singular_values_by_rotations(const Matrix& Z);

/// The singular values by divide and conquer, in decreasing order.
Vector singular_values(const Matrix& Z);

}  // namespace convex::linear_algebra
