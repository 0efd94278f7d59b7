#pragma once

namespace convex {

/// [low, high]; the ends may be infinite.
struct Interval {
  double low = 0, high = 0;
};

}  // namespace convex
