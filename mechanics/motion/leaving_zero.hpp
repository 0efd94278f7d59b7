#pragma once

#include <cstddef>
#include <span>

namespace mechanics::inline motions {

/// Where Σ c_k τ^k, k >= `first`, comes to `farthest` > 0 from 0, without the terms that are no more than
/// their rounding.
struct LeavingTerm {
  std::size_t order;  ///< of the terms with the sign that the sum has there the one that comes so far first
  double at;
};

/// c: c_first is more than its rounding. A sum whose terms cancel as far as they are followed leaves with the
/// term that comes so far first, and so does one of which the terms are looked at alone.
LeavingTerm leaving_term(std::span<const double> c, std::span<const double> by_rounding, std::size_t first,
                         double farthest, bool alone = false);

}  // namespace mechanics::inline motions
