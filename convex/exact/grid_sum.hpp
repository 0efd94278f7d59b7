#pragma once

#include <optional>

#include "convex/vector.hpp"

namespace convex::inline exact_arithmetic {

/// Sums Σ u_i q_i - s that doubles make without rounding, as they do where the numbers are multiples of a
/// power of 2 each and not too many times that: dyadic data, in short.
class GridSum {
 public:
  /// q is referred to.
  explicit GridSum(const Eigen::Ref<const Vector>& q);
  /// u·q - s; none when rounding cannot be excluded. u: as many entries as q.
  std::optional<double> value(const double* u, double s) const;

 private:
  const double* q_;
  Index n_;
  bool is_zero_ = false;
  double step_ = 0;   ///< all of q are multiples of this power of 2; 0 when there are too many of them
  double steps_ = 0;  ///< at least n max |q_i| / step_
};

}  // namespace convex::inline exact_arithmetic
