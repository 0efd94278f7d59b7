#pragma once

#include <cstdlib>
#include <memory>

#include "convex/dense/dense_kernels.hpp"

namespace convex::linear_algebra {

/// The Cholesky factor of a dense W as `DenseKernels` wants it. A W that is not positive definite leaves
/// numbers on the diagonal that are not positive or not finite.
class PaddedTriangle {
 public:
  /// W, to be factored. Whether it is its own transpose, not one bit off, and finite. Room is kept for
  /// another of that size.
  bool take(const Matrix& W);
  void factor();
  /// The factor itself, lower, with a positive diagonal.
  void take_factor(const Matrix& L);

  Index ld() const { return ld_; }
  const double* T() const { return T_; }
  const double* inverse() const { return T_ + ld_ * ld_; }
  /// L in the lower triangle, its transpose in the upper one: n×n.
  Eigen::Map<const Matrix, 0, Eigen::OuterStride<>> view() const { return {T_, n_, n_, {ld_}}; }

 private:
  struct Free {
    void operator()(double* room) const { std::free(room); }
  };
  Index n_ = 0, ld_ = 0;
  std::unique_ptr<double, Free> room_;
  double* T_ = nullptr;
};

}  // namespace convex::linear_algebra
