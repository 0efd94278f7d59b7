#pragma once

#include <bit>
#include <cstdint>

#include "convex/piecewise/piecewise_quadratic.hpp"

namespace oracles {

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Whether two functions are stored as the same bytes.
inline bool same_bytes(const convex::PiecewiseQuadratic& f, const convex::PiecewiseQuadratic& g) {
  if (f.corners().size() != g.corners().size()) return false;
  for (std::size_t k = 0; k < f.corners().size(); ++k)
    if (!same_bits(f.corners()[k].x, g.corners()[k].x) || !same_bits(f.corners()[k].y, g.corners()[k].y))
      return false;
  for (std::size_t k = 0; k < f.segments().size(); ++k) {
    const convex::Segment &a = f.segments()[k], &b = g.segments()[k];
    if (!same_bits(a.run, b.run) || !same_bits(a.rise, b.rise) || !same_bits(a.x, b.x) ||
        !same_bits(a.y, b.y) || !same_bits(a.f, b.f) || !same_bits(a.g, b.g))
      return false;
  }
  return true;
}

}  // namespace oracles
