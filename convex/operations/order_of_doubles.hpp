#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace convex::inline operations {

using Rank = std::int64_t;

/// The place of a double among all in their order; that of 0 is 0, and neighbours differ by 1.
inline Rank rank_of(double x) {
  const Rank bits = std::bit_cast<Rank>(std::abs(x));
  return std::signbit(x) ? -bits : bits;
}

inline double double_of(Rank rank) {
  const double size = std::bit_cast<double>(rank < 0 ? -rank : rank);
  return rank < 0 ? -size : size;
}

}  // namespace convex::inline operations
