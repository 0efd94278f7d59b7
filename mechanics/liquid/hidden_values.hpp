#pragma once

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// Between the least and the largest of the numbers taken.
struct Hull {
  double low = convex::infinity, high = -convex::infinity;

  void take(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// By how much values leave it.
  double left_by(const expression::Range& values) const {
    return values.is_empty() ? 0 : std::max({values.high - high, low - values.low, 0.0});
  }
};

/// In fewer than three dimensions the rest is 0.
Point middle_of(const Region&);
/// The square of its diagonal along the first d axes.
double diagonal_squared(const Region&, std::size_t d);

/// Calls work with the corners of a region of d dimensions.
template <class Work>
void for_corners(const Region& at, std::size_t d, Work work) {
  for (unsigned code = 0; code < 1U << d; ++code) {
    Point x{};
    for (std::size_t i = 0; i < d; ++i) x[i] = (code >> i & 1U) != 0 ? at[i].high : at[i].low;
    work(x);
  }
}

/// Calls work with what of the boundary lies in a region: of a box the sides, which are flat, else the
/// region.
template <class Work>
void for_boundary(const Domain& domain, const Region& at, Work work) {
  if (domain.shape != Domain::Shape::box) return work(at);
  for (std::size_t i = 0; i < domain.dimension; ++i)
    for (const double side : {domain.low[i], domain.high[i]}) {
      if (at[i].low > side + domain.reach() || at[i].high < side - domain.reach()) continue;
      Region flat = at;
      flat[i] = {side, side};
      work(flat);
    }
}

/// How often a region is halved along all its d axes; how many may be looked at, counted down: intervals that
/// stay wide take no more.
struct Halving {
  std::size_t d;
  int depth;
  long* left;
};

/// Whether is_found(piece, most, depth left) is so of a region or one of its pieces, halved along all axes.
/// Passed by with all their pieces are those in which what is looked for is at most 0: `bound` is above all
/// of it in a region.
template <class AtMost, class IsFound>
bool search(const Region& at, const Halving& halving, const AtMost& bound, const IsFound& is_found) {
  const double most = bound(at);
  if (!(most > 0) || --*halving.left < 0) return false;
  if (is_found(at, most, halving.depth)) return true;
  if (halving.depth == 0) return false;
  const Point middle = middle_of(at);
  for (unsigned code = 0; code < 1U << halving.d; ++code) {
    Region piece = at;
    bool is_again = false;  // of a flat region
    for (std::size_t i = 0; i < halving.d; ++i) {
      const bool is_high = (code >> i & 1U) != 0;
      is_again = is_again || (is_high && at[i].low == at[i].high);
      (is_high ? piece[i].low : piece[i].high) = middle[i];
    }
    if (is_again) continue;
    if (search(piece, {halving.d, halving.depth - 1, halving.left}, bound, is_found)) return true;
  }
  return false;
}

using Places = std::array<convex::Index, 3>;

/// Calls tells(first, last) of a box of places and, as long as it does not tell, of its halves across the
/// longest side, down to single places.
template <class Tells>
void halve_places(const Places& first, const Places& last, const Tells& tells) {
  if (tells(first, last)) return;
  std::size_t axis = 0;
  for (std::size_t i = 1; i < first.size(); ++i)
    if (last[i] - first[i] > last[axis] - first[axis]) axis = i;
  if (first[axis] == last[axis]) return;
  Places end = last, begin = first;
  end[axis] = (first[axis] + last[axis]) / 2;
  begin[axis] = end[axis] + 1;
  halve_places(first, end, tells);
  halve_places(begin, last, tells);
}

}  // namespace mechanics::liquid
