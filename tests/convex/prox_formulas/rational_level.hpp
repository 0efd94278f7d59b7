#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <vector>

#include "convex/vector.hpp"

namespace oracles {

using Rational = mpq_class;
using RationalVector = std::vector<Rational>;

inline RationalVector rational(const convex::Vector& z) {
  RationalVector q;
  for (double v : z) q.emplace_back(v);
  return q;
}

/// max_i |x_i - exact_i|.
inline double distance(const convex::Vector& x, const RationalVector& exact) {
  Rational largest = 0;
  for (std::size_t i = 0; i < exact.size(); ++i)
    largest = std::max(largest, Rational(abs(Rational(x[static_cast<convex::Index>(i)]) - exact[i])));
  return largest.get_d();
}

/// Σ clamp(slope_i (point_i - level), 0, cap) in fractions; cap < 0 stands for none.
inline Rational height(const RationalVector& point, const RationalVector& slope, const Rational& cap,
                       const Rational& level) {
  Rational sum = 0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    Rational term = std::max(Rational(0), Rational(slope[i] * (point[i] - level)));
    if (cap >= 0) term = std::min(term, cap);
    sum += term;
  }
  return sum;
}

/// The level of that height, by trying every breakpoint in order.
inline Rational level_of_height(const RationalVector& point, const RationalVector& slope, const Rational& cap,
                                const Rational& total) {
  RationalVector breaks;
  for (std::size_t i = 0; i < point.size(); ++i) {
    breaks.push_back(point[i]);
    if (cap >= 0) breaks.push_back(point[i] - cap / slope[i]);
  }
  std::sort(breaks.begin(), breaks.end());
  // Without caps the sum grows below the last breakpoint at the full slope.
  Rational above = breaks.back(), height_above = height(point, slope, cap, above);
  for (std::size_t k = breaks.size(); k-- > 0;) {
    const Rational below = breaks[k], height_below = height(point, slope, cap, below);
    if (height_below >= total) {
      if (height_below == height_above) return below;
      return above + (below - above) * (total - height_above) / (height_below - height_above);
    }
    above = below;
    height_above = height_below;
  }
  Rational slopes = 0;
  for (const Rational& s : slope) slopes += s;
  return above - (total - height_above) / slopes;
}

}  // namespace oracles
