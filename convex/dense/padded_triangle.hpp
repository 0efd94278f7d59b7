#pragma once

#include <cstdlib>
#include <memory>

#include "convex/dense/dense_kernels.hpp"

namespace convex::inline dense {

/// The Cholesky factor of a dense W as `DenseKernels` wants it. A W that is not positive definite leaves
/// numbers on the diagonal that are not positive or not finite.
class PaddedTriangle {
 public:
  /// W itself, to be factored.
  explicit PaddedTriangle(const Matrix& W);
  bool is_exactly_symmetric() const { return is_exactly_symmetric_; }
  void factor();
  ~PaddedTriangle();
  PaddedTriangle(const PaddedTriangle&) = delete;
  PaddedTriangle& operator=(const PaddedTriangle&) = delete;

  Index ld() const { return ld_; }
  const double* T() const { return T_; }
  const double* inverse() const { return T_ + ld_ * ld_; }
  /// L in the lower triangle, its transpose in the upper one: n×n.
  Eigen::Map<const Matrix, 0, Eigen::OuterStride<>> view() const { return {T_, n_, n_, {ld_}}; }

 private:
  Index n_, ld_;
  double *room_, *T_;
  bool is_exactly_symmetric_;
};

}  // namespace convex::inline dense
