#pragma once

#include <limits>

#include "convex/vector.hpp"

namespace convex::prox_formulas {

/// The level with Σ clamp(slope_i (point_i - level), 0, cap) = total; point, slope: n, slopes positive;
/// 0 <= total <= n cap, total finite, cap may be infinite. If a whole interval will do, one of its points.
///
/// Without a cap by dropping terms below a rising lower bound: O(n) observed. With one, the breakpoints still
/// inside the bracket are halved, in the mean, by each evaluation at one drawn among them, and what is
/// decided for the whole bracket is summed once: O(n) expected. Right up to the rounding of sums.
double water_level(const Vector& point, const Vector& slope, double cap, double total);

/// The same rounded once: from that level by Newton's steps on the piecewise linear sum, in twice the working
/// precision. Where slopes are far apart, the sum cancels.
double exact_water_level(const Vector& point, const Vector& slope, double cap, double total);

/// clamp(v - level/d, 0, cap) with Σ = total, n entries, each rounded once: likewise, for where weights d are
/// far apart, v_i - level/d_i is a small difference of large numbers for some of them.
Vector clamped_to_total(const Vector& v, const Vector& d, double cap, double total);

}  // namespace convex::prox_formulas
