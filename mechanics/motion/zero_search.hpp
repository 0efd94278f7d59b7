#pragma once

#include <vector>

#include "mechanics/motion/arc.hpp"

namespace mechanics::inline motions {

/// Something on an arc that comes to 0.
struct Zero {
  enum class Of { constraint, multiplier, branch };
  Of of;
  Index which;  ///< the constraint, or the switch
  double at;    ///< τ
  bool is_touch = false;
  bool is_soft = false;  ///< it comes to 0 with its rate, and does not go up again
  bool is_jump = false;  ///< past it, and not through it
  double left = 0;       ///< of an argument: so far rounding may have made it
};

/// What is watched on an arc.
struct Watched {
  Zero::Of of;
  Index which;
  std::vector<double> c;  ///< coefficients, positive just after the beginning, without the leading zeros
  double rounding;        ///< what rounding leaves of a 0, besides that of the terms
  int zeros = 0;          ///< how many those are
};

/// The zeros of what is watched in (0, end], the first one of each; those not first in time by more than
/// `together` are left out.
std::vector<Zero> first_zeros(const std::vector<Watched>& watched, double end, double together);

}  // namespace mechanics::inline motions
