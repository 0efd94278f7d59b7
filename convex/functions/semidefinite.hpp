#pragma once

#include "convex/vector.hpp"

namespace convex::inline named_functions {

/// A symmetric positive semidefinite Q of rank r: Q = L Lᵀ, L = basis · diag(root), n×r, and `null`, n×(n -
/// r), is the rest of an orthonormal basis.
struct Spectrum {
  Matrix basis, null;
  Vector values;  ///< the positive eigenvalues: r
  /// Is that the rank of Q as it stands, as its eigenvalues or fractions tell? An eigenvalue that is 0 but
  /// for rounding counts as 0 where it is not.
  bool is_sure = true;
  Matrix factor() const { return basis * values.cwiseSqrt().asDiagonal(); }
  Matrix pseudoinverse() const { return basis * values.cwiseInverse().asDiagonal() * basis.transpose(); }
};

/// Eigenvalues below this part of the largest, times n, are rounding.
inline constexpr double rank_tolerance = 8 * unit_roundoff;

/// That of a symmetric Q, n×n. Where eigenvalues do not tell the rank, it is decided in integers (n up to
/// 64). Throws `InvalidInput` where an eigenvalue is negative by more than rounding.
Spectrum spectrum_of(const Matrix& Q);

}  // namespace convex::inline named_functions
