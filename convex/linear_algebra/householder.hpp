#pragma once

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// V = QR by reflections, V n×k, in the order of its columns (Eigen's HouseholderQR).
class Householder {
 public:
  explicit Householder(const Matrix& V);

  /// The first `columns` columns of Q, at most n: with k of them QR = V; the rest spans what is orthogonal to
  /// V.
  Matrix Q(Index columns) const;
  /// The upper triangle R, k×k; k <= n.
  Matrix R() const;
  /// X := R⁻¹X, k <= n.
  void solve_R_in_place(Matrix& X) const;
  /// The X of least |VX - B|; k <= n, R regular.
  Matrix least_squares(const Matrix& B) const;

 private:
  Matrix reflections_;  ///< their vectors below the diagonal, R on it and above
  Vector coefficients_;
};

}  // namespace convex::linear_algebra
