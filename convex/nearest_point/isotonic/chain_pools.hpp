#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "convex/dense/arena.hpp"
#include "convex/double_double.hpp"
#include "convex/nearest_point/isotonic/strings.hpp"

namespace convex::inline isotonic {

/// Of pairs that are tidy.
inline bool less(DoubleDouble x, DoubleDouble y) { return x.hi < y.hi || (x.hi <= y.hi && x.lo < y.lo); }

/// A chain whose rows lead from each coordinate to the next, the floor first: member k is coordinate k.
struct InOrder {
  const double* value;  ///< of U
  Index floor;          ///< rows before the first link: 1 or 0
  bool plain;           ///< all factors of links are 1
  Index coordinate(Index k) const { return k; }
  Index row(Index k) const { return k - 1 + floor; }
  double factor(Index k) const { return value[2 * k - 1 + floor]; }
};

/// None when the rows stand otherwise, or when the problem is no chain.
std::optional<InOrder> in_order(const NearestPointProblem&);

/// A chain in any order.
struct Listed {
  const Strings& strings;
  const SparseRows& U;
  static constexpr bool plain = false;
  Index coordinate(Index k) const { return strings.coordinate[at(k)]; }
  Index row(Index k) const { return strings.row[at(k)]; }
  double factor(Index k) const { return std::abs(U.valuePtr()[U.outerIndexPtr()[row(k)]]); }
};

/// A chain, bottom to top, as pooling sees it: member k is coordinate order.coordinate(k), the row below it
/// order.row(k), -1 for none, with the factor order.factor(k).
template <class Order>
struct Chain {
  /// Numbers of all members stand in the arena.
  Chain(const NearestPointProblem&, const Order&, Arena&);
  /// Cache lines that it and `pool` take.
  static Index lines(Index n) { return 5 * padded(n) / 8 + 1; }
  /// s/c of the row below member k.
  DoubleDouble bound(Index k) const;
  /// The linear term of member k in the coordinates y that pools have in common.
  DoubleDouble load(Index k) const {
    const Index i = order.coordinate(k);
    const DoubleDouble plain{linear[i], 0};
    return is_level() ? plain : add(plain, negative(product({offset_hi[k], offset_lo[k]}, mass[i])));
  }
  bool is_level() const { return !offset_hi; }
  Index n;
  const double *mass, *linear, *s;
  Order order;
  double *offset_hi = nullptr, *offset_lo = nullptr;  ///< of a member over the first; none when all are 0
  double farthest_offset = 0, total_mass = 0;         ///< |offset| at most, and Σ m, where there are offsets
};

/// The first members of the pools, by sums in doubles: right but for rounding. Then n.
template <class Order>
std::vector<int> pool(const Chain<Order>&, Arena&);

/// The same with sums in twice the precision, which are compared in that precision where doubles do not tell.
template <class Order>
std::vector<int> pool_carefully(const Chain<Order>&);

}  // namespace convex::inline isotonic
