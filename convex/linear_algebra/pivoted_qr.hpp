#pragma once

#include <vector>

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// V P = QR by reflections, V m×n, the longest rest of a column first (Eigen's ColPivHouseholderQR).
struct PivotedQr {
  explicit PivotedQr(const Matrix& V);

  std::vector<Index> order;  ///< the column of V that comes k-th
  Vector pivots;             ///< |R_kk|, the length of the rest of the k-th column: min(m, n)
  Index rank;                ///< how many of them are above rounding (m, n times that of the largest)
};

/// The x of least |Vx - b|, with 0 for columns that depend on those of longer rests.
Vector least_squares(const Matrix& V, const Vector& b);

}  // namespace convex::linear_algebra
