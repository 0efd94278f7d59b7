#pragma once

#include <vector>

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// P A = L U of an A that need not be symmetric, n×n, by elimination with row pivots (Eigen's PartialPivLU).
class PivotedLu {
 public:
  PivotedLu() = default;
  explicit PivotedLu(const Matrix& A);

  /// Whether no pivot was 0 and all are finite. The rest may be asked for only then.
  bool is_regular() const { return is_regular_; }
  /// A⁻¹b.
  Vector solve(const Vector& b) const;

 private:
  Matrix LU_;               ///< U, and below its diagonal L without its ones
  std::vector<Index> row_;  ///< that to which row i of A went
  bool is_regular_ = false;
};

}  // namespace convex::linear_algebra
