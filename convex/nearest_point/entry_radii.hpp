#pragma once

#include "convex/nearest_point/problem.hpp"

namespace convex {

/// How far the numbers of a nearest-point problem may be from those that are meant, entry by entry:
/// |A - A*| <= A and so on, all radii >= 0, infinite where nothing is known. An entry outside of a pattern is
/// certain. A radius of 0 is an exact number.
struct EntryRadii {
  SparseMatrix A;  ///< n×n, symmetric
  Vector z;        ///< n
  SparseRows U;    ///< m×n
  Vector s;        ///< m

  /// The same by rows, as methods use them: `longest_within` of U in the metric, and ŝ.
  DataRadii by_rows(const Metric& metric) const { return {longest_within(ConstraintRows(U), metric), s}; }
  /// Whether every number is known.
  bool is_finite() const {
    return A.coeffs().allFinite() && z.allFinite() && U.coeffs().allFinite() && s.allFinite();
  }
  /// Whether every number is exact.
  bool is_zero() const { return A.coeffs().isZero(0) && z.isZero(0) && U.coeffs().isZero(0) && s.isZero(0); }
};

}  // namespace convex
