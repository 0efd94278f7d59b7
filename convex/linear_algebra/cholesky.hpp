#pragma once

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// W = L Lᵀ of a symmetric W, n×n, of which the lower triangle is read (Eigen's LLT).
class Cholesky {
 public:
  Cholesky() = default;
  explicit Cholesky(const Matrix& W);

  /// Whether every pivot was positive, so that W is positive definite in working precision. The rest may be
  /// asked for only then.
  bool is_definite() const { return is_definite_; }
  /// That of L: n.
  Vector diagonal() const { return L_.diagonal(); }
  Matrix L() const;
  /// W⁻¹b.
  Vector solve(const Vector& b) const;
  /// W⁻¹B.
  Matrix solve_columns(const Matrix& B) const;
  Matrix inverse() const { return solve_columns(Matrix::Identity(L_.rows(), L_.rows())); }
  /// X := L⁻¹X.
  void solve_lower_in_place(Matrix& X) const;
  /// X := L⁻ᵀX.
  void solve_upper_in_place(Matrix& X) const;

 private:
  Matrix L_;  ///< above its diagonal, what W has there
  bool is_definite_ = false;
};

/// W := L in the lower triangle; false when a pivot was not positive.
bool factor_in_place(Eigen::Ref<Matrix> W);

}  // namespace convex::linear_algebra
