#pragma once

#include <cmath>
#include <optional>

#include "convex/vector.hpp"

namespace convex::inline exact_arithmetic {

/// Numbers, referred to, of which it is remembered on which grids they lie: the multiples of a power of 2.
class GridTest {
 public:
  GridTest(Index count, const double* x) : count_(count), x_(x) {}
  double largest();
  /// Whether all are multiples of `step`, a power of 2, and no more than 2⁵² of it.
  bool is_on(double step);

 private:
  Index count_;
  const double* x_;
  double largest_ = -1;            ///< -1 before they were looked at
  double coarsest_on_ = 0;         ///< the coarsest grid that they are known to lie on,
  double finest_off_ = 0x1p+1023;  ///< the finest that they are known not to lie on
};

/// Whether x is a multiple of `step`, a power of 2, and no more than 2⁵² of it; whatever x is where step = 0.
inline bool is_on_grid(double x, double step) {
  const double most = 0x1p52 * step, shift = 1.5 * most;
  return step == 0 || (std::abs(x) <= most && (x + shift) - shift == x);
}

/// Sums Σ u_i q_i - s that doubles make without rounding, as they do where the numbers are multiples of a
/// power of 2 each and not too many times that: dyadic data, in short.
class GridSum {
 public:
  /// q is referred to.
  explicit GridSum(const Eigen::Ref<const Vector>& q);
  /// u·q - s; none when rounding cannot be excluded. u: as many entries as q.
  std::optional<double> value(const double* u, double s) const;
  /// The step of the grid on which s is to lie for u·q - s to be made without rounding, in any order, where
  /// the entries of u are among `rows`; 0 where any s will do, none when rounding cannot be excluded.
  std::optional<double> step_of_sums(GridTest& rows) const;

 private:
  const double* q_;
  Index n_;
  bool is_zero_ = false;
  double step_ = 0;   ///< all of q are multiples of this power of 2; 0 when there are too many of them
  double steps_ = 0;  ///< at least n max |q_i| / step_
};

}  // namespace convex::inline exact_arithmetic
