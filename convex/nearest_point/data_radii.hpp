#pragma once

#include "convex/vector.hpp"

namespace convex {

/// How far the numbers of a nearest-point problem may be from those that are meant, entry by entry:
/// |A - A*| <= A and so on, all radii >= 0, infinite where nothing is known. An entry outside of a pattern is
/// certain. A radius of 0 is an exact number.
struct DataRadii {
  SparseMatrix A;  ///< n×n, symmetric
  Vector z;        ///< n
  SparseRows U;    ///< m×n
  Vector s;        ///< m

  /// Whether every number is known.
  bool is_finite() const;
  /// Whether every number is exact.
  bool is_zero() const;
};

}  // namespace convex
