#pragma once

#include <algorithm>
#include <cmath>

#include "convex/vector.hpp"

namespace convex::inline composite {

/// A value and a derivative of an increasing function.
struct ValueAndSlope {
  double value = 0, slope = 1;
};

/// The root mu >= 0 of an increasing function of mu > 0 whose slope is at least 1, by Newton steps kept
/// inside a bracket: |value| and the rounding of mu bound the distance to the root on either side. 0 when the
/// root is below `smallest`. `start` > 0; values may be infinite.
template <class Increasing>
double monotone_root(const Increasing& increasing, double start, double smallest) {
  double low = 0, high = std::numeric_limits<double>::infinity(), mu = start, halved = high;
  constexpr int step_limit = 200;  // bisection of exponents and bits alone, every third step, ends within it
  constexpr double farthest = 0x1p400;  // times and over data it is a double still
  constexpr double roundings = 8;       // of mu in mu - value, which may cancel
  for (int step = 0; step < step_limit; ++step) {
    const ValueAndSlope at = increasing(mu);
    if (at.value == 0) return mu;
    const double rounding = roundings * unit_roundoff * mu;
    if (at.value < 0) {
      low = mu;
      high = std::min(high, mu - at.value + rounding);
    } else {
      high = mu;
      low = std::max(low, mu - at.value - rounding);
    }
    if (high <= smallest) return 0;
    if (!(high - low > 2 * unit_roundoff * high)) break;
    double next = mu - at.value / at.slope;
    // Newton's steps creep where the slope bends at once: the bracket is to be halved by every third step.
    const bool creeping = step % 3 == 2 && high - low > 0.5 * halved;
    if (step % 3 == 2) halved = high - low;
    if (!(next > low && next < high) || creeping) {
      const bool wide = low < high / 16;
      next = wide ? (low > 0 ? std::sqrt(low) * std::sqrt(high) : 1e-3 * high) : 0.5 * (low + high);
      if (!std::isfinite(high)) next = 16 * mu;
      if (!(next < farthest)) return mu;  // no finite value on the way
    }
    if (std::abs(next - mu) <= unit_roundoff * mu) return next;
    mu = next;
  }
  return 0.5 * (low + high);
}

}  // namespace convex::inline composite
