#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "convex/dense/arena.hpp"
#include "convex/double_double.hpp"
#include "convex/nearest_point/isotonic/exact_rise.hpp"
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
  template <class Work>
  void each_string(Index n, Work work) const {
    work(Index{0}, n);
  }
};

/// None when the rows stand otherwise, or when the problem is no chain.
std::optional<InOrder> in_order(const NearestPointProblem&);

/// A chain in any order, or strings one after the other.
struct Listed {
  const Strings& strings;
  const SparseRows& U;
  static constexpr bool plain = false;
  Index coordinate(Index k) const { return strings.coordinate[at(k)]; }
  Index row(Index k) const { return strings.row[at(k)]; }
  double factor(Index k) const { return std::abs(U.valuePtr()[U.outerIndexPtr()[row(k)]]); }
  template <class Work>
  void each_string(Index, Work work) const {
    for (std::size_t t = 0; t + 1 < strings.first.size(); ++t)
      work(Index{strings.first[t]}, Index{strings.first[t + 1]});
  }
};

/// A chain, bottom to top, as pooling sees it: member k is coordinate order.coordinate(k), the row below it
/// order.row(k), -1 for none, with the factor order.factor(k). Or strings: of the first of each the row below
/// is its floor.
template <class Order>
struct Chain {
  /// Numbers of all members stand in the arena.
  Chain(const NearestPointProblem&, const Order&, Arena&);
  /// Cache lines that it and `pool` take.
  static Index lines(Index n) { return 5 * padded(n) / 8 + 1; }
  /// s/c of the row below member k.
  DoubleDouble bound(Index k) const;
  /// What a linear term of member k becomes in the coordinates y that pools have in common.
  DoubleDouble lowered(Index k, DoubleDouble term) const {
    return is_level() ? term : add(term, negative(product(offset(k), mass[order.coordinate(k)])));
  }
  bool is_level() const { return !offset_hi; }
  DoubleDouble offset(Index k) const {
    return is_level() ? DoubleDouble{} : DoubleDouble{offset_hi[k], offset_lo[k]};
  }
  /// As fractions want them; of the chain, which is referred to.
  StringMembers members() const {
    return [this](Index k) {
      const Index i = order.coordinate(k), below = order.row(k);
      return below < 0 ? StringMember{mass[i], linear[i], 1, 0}
                       : StringMember{mass[i], linear[i], order.factor(k), s[below]};
    };
  }
  Index n;
  const double *mass, *linear, *s;
  Order order;
  double *offset_hi = nullptr, *offset_lo = nullptr;  ///< over the first of the string; none when all are 0
  double farthest_offset = 0, total_mass = 0;         ///< |offset| at most, and Σ m, where there are offsets
};

/// The first members of the pools, by sums in doubles: right but for rounding. Then n.
template <class Order>
std::vector<int> pool(const Chain<Order>&, Arena&);

/// The same of the members begin … end - 1, with loads and sums in twice the precision, which are compared in
/// that precision where doubles do not tell. Then `end`.
template <class Order>
std::vector<int> pool_carefully(const Chain<Order>&, Index begin, Index end,
                                const std::function<DoubleDouble(Index)>& load);

}  // namespace convex::inline isotonic
