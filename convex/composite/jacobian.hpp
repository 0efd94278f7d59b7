#pragma once

#include "convex/vector.hpp"

namespace convex::inline composite {

/// An element J of the generalised Jacobian of a prox (Clarke 1983), n×n: a full matrix, or the thin
/// diag(a) + U C Uᵀ with few columns in U (n×r) and C symmetric, with which products cost O(n r) and systems
/// little more (Woodbury 1950). A separable function's has r = 0.
class Jacobian {
 public:
  template <class Derived>
  Jacobian(const Eigen::MatrixBase<Derived>& full) : full_(full), is_thin_(false) {}
  template <class Derived>
  Jacobian(const Eigen::DiagonalBase<Derived>& diagonal) : Jacobian(Vector(diagonal.diagonal())) {}
  explicit Jacobian(Vector a) : a_(std::move(a)), U_(a_.size(), 0), C_(0, 0) {}
  Jacobian(Vector a, Matrix U, Matrix C) : a_(std::move(a)), U_(std::move(U)), C_(std::move(C)) {}
  /// Of fewer rows a full matrix costs as little, and rounds less where it is nearly singular.
  static constexpr Index least_thin = 64;
  static Jacobian identity(Index n) { return Jacobian(Vector(Vector::Ones(n))); }

  bool is_thin() const { return is_thin_; }
  /// Of a thin one.
  const Vector& a() const { return a_; }
  const Matrix& U() const { return U_; }
  const Matrix& C() const { return C_; }

  operator Matrix() const;
  Vector diagonal() const;
  Vector operator*(const Vector& v) const;
  /// I - D⁻¹J D of a diagonal D: that of the conjugate's prox, J being taken in D⁻¹ at Dz. d: n.
  Jacobian of_conjugate(const Vector& d) const;
  /// Of one variable more: diag(J, 0) + (m, e) B (m, e)ᵀ, m filled up with 0 and e the last unit vector.
  /// m: n; B: 2×2, symmetric.
  Jacobian bordered(const Vector& m, const Eigen::Matrix2d& B) const;

 private:
  Matrix full_;
  Vector a_;
  Matrix U_, C_;
  bool is_thin_ = true;
};

}  // namespace convex::inline composite
