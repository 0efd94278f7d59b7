#include "convex/nearest_point/isotonic/chain_pools.hpp"

#include <cmath>
#include <memory>

#include "convex/nearest_point/isotonic/chain_kernels.hpp"

namespace convex::inline isotonic {
namespace {

/// Members that move together, from `begin` to the next pool.
template <class Sum>
struct Pool {
  int begin;
  Sum weight, sum;
};

void absorb(Pool<double>& pool, const Pool<double>& other) {
  pool.weight += other.weight;
  pool.sum += other.sum;
}

void absorb(Pool<RunningSum>& pool, const Pool<RunningSum>& other) {
  pool.weight.add(DoubleDouble{other.weight.hi, other.weight.lo});
  pool.sum.add(DoubleDouble{other.sum.hi, other.sum.lo});
}

/// Whether the mean of x is less than that of y.
bool rises(const Pool<double>& x, const Pool<double>& y) { return x.sum * y.weight < y.sum * x.weight; }

bool rises(const Pool<RunningSum>& x, const Pool<RunningSum>& y) {
  // Doubles tell two means apart unless the products that compare them are closer, or out of range.
  constexpr double doubt = 0x1p-48, tiny = 0x1p-960, huge = 0x1p990;
  const double below = x.sum.value() * y.weight.value(), above = y.sum.value() * x.weight.value();
  const double difference = above - below, terms = std::abs(above) + std::abs(below);
  if (std::abs(difference) > doubt * terms + tiny && terms < huge) return difference > 0;
  const DoubleDouble x_sum = x.sum.tidy(), x_weight = x.weight.tidy(), y_sum = y.sum.tidy(),
                     y_weight = y.weight.tidy();
  if (terms < huge && terms > tiny / doubt)
    return less(product_of_pairs(x_sum, y_weight), product_of_pairs(y_sum, x_weight));
  return less(quotient(x_sum, x_weight), quotient(y_sum, y_weight));
}

/// Pools of the members that `member` makes, n of them, adjacent violators together; bottom: room for n.
template <class Sum, class Member>
std::vector<int> pool_members(Index n, Pool<Sum>* const bottom, const Member member) {
  Pool<Sum>* free = bottom;
  Pool<Sum> top = member(0);
  for (Index k = 1; k < n; ++k) {
    const Pool<Sum> next = member(k);
    if (rises(top, next)) {
      *free++ = top;
      top = next;
    } else {
      absorb(top, next);
      for (; free != bottom && !rises(free[-1], top); --free) {
        absorb(top, free[-1]);
        top.begin = free[-1].begin;
      }
    }
  }
  *free++ = top;
  std::vector<int> first(at(free - bottom) + 1, static_cast<int>(n));
  for (const Pool<Sum>* pool = bottom; pool != free; ++pool) first[at(pool - bottom)] = pool->begin;
  return first;
}

}  // namespace

std::optional<InOrder> in_order(const NearestPointProblem& problem) {
  if (!is_diagonal(problem.A) || !problem.U.is_sparse() || !problem.two_sided.empty()) return std::nullopt;
  const SparseRows& U = problem.U.sparse();
  const Index n = problem.dimension(), m = problem.rows();
  if (n == 0 || !U.isCompressed() || (m != n && m != n - 1)) return std::nullopt;
  const int floor = m == n ? 1 : 0;
  if (U.nonZeros() != 2 * (n - 1) + floor) return std::nullopt;
  const int *outer = U.outerIndexPtr() + floor, *inner = U.innerIndexPtr();
  const double* value = U.valuePtr();
  if (floor == 1 && !(outer[0] == 1 && inner[0] == 0 && value[0] > 0)) return std::nullopt;
  inner += floor;
  value += floor;
  constexpr int block = 512;  // looked at without a branch
  const int links = static_cast<int>(n) - 1;
  Index ones = 0;
  for (int first = 0; first < links; first += block) {
    const int end = std::min(links, first + block);
    int wrong = 0;
    for (int a = first; a < end; ++a)
      wrong |= (outer[a] ^ (2 * a + floor)) | (inner[2 * a] ^ a) | (inner[2 * a + 1] ^ (a + 1));
    const Index fit = chain_kernels::count_links(end - first, value + 2 * first, ones);
    if (wrong != 0 || fit != end - first) return std::nullopt;
  }
  return InOrder{U.valuePtr(), floor, ones == links};
}

template <class Order>
DoubleDouble Chain<Order>::bound(Index k) const {
  const double c = order.factor(k), height = s[order.row(k)];
  return c == 1 ? DoubleDouble{height, 0} : quotient({height, 0}, {c, 0});
}

template <class Order>
Chain<Order>::Chain(const NearestPointProblem& problem, const Order& the_order, Arena& arena)
    : n(problem.dimension()),
      mass(problem.A.diagonal().data()),
      linear(problem.z.data()),
      s(problem.s.data()),
      order(the_order) {
  bool level = true;  // but for floors
  order.each_string(n, [&](Index begin, Index end) {
    for (Index k = begin + 1; k < end && level; ++k) level = std::abs(s[order.row(k)]) <= 0;
  });
  if (level) return;
  offset_hi = arena.take<double>(n);
  offset_lo = arena.take<double>(n);
  order.each_string(n, [&](Index begin, Index string_end) {
    constexpr Index at_once = 64;  // terms that do not wait for a sum to be tidy
    RunningSum sum;
    offset_hi[begin] = offset_lo[begin] = 0;
    for (Index first = begin; first < string_end; first += at_once) {
      const Index end = std::min(first + at_once, string_end);
      const auto add_up = [&](const auto bound_below) {
        for (Index k = std::max(first, begin + 1); k < end; ++k) {
          sum.add(bound_below(k));
          offset_hi[k] = sum.hi;
          offset_lo[k] = sum.lo;
        }
      };
      if (order.plain)
        add_up([bounds = s, row = order](Index k) { return bounds[row.row(k)]; });
      else
        add_up([this](Index k) { return bound(k); });
      chain_kernels::make_tidy(end - first, offset_hi + first, offset_lo + first);
      farthest_offset =
          std::max(farthest_offset, dense_kernels().largest_size(end - first, offset_hi + first));
      const DoubleDouble tidy = sum.tidy();
      sum = {tidy.hi, tidy.lo};
    }
  });
  total_mass = problem.A.diagonal().sum();
}

template <class Order>
std::vector<int> pool(const Chain<Order>& chain, Arena& arena) {
  static_assert(sizeof(Pool<double>) == 3 * sizeof(double));
  auto* const room = new (arena.take<double>(3 * chain.n)) Pool<double>[at(chain.n)];
  const auto member = [order = chain.order, mass = chain.mass, linear = chain.linear](Index k) {
    const Index i = order.coordinate(k);
    return Pool<double>{static_cast<int>(k), mass[i], linear[i]};
  };
  if (chain.is_level()) return pool_members(chain.n, room, member);
  return pool_members(chain.n, room, [member, offset = chain.offset_hi](Index k) {
    Pool<double> lowered = member(k);
    lowered.sum -= offset[k] * lowered.weight;
    return lowered;
  });
}

template <class Order>
std::vector<int> pool_carefully(const Chain<Order>& chain, Index begin, Index end,
                                const std::function<DoubleDouble(Index)>& load) {
  const auto room = std::make_unique_for_overwrite<Pool<RunningSum>[]>(at(end - begin));
  std::vector<int> first = pool_members(end - begin, room.get(), [&](Index member) {
    const Index k = begin + member;
    const DoubleDouble own = load(k);
    return Pool<RunningSum>{
        static_cast<int>(k), {chain.mass[chain.order.coordinate(k)], 0}, {own.hi, own.lo}};
  });
  first.back() = static_cast<int>(end);
  return first;
}

template struct Chain<InOrder>;
template struct Chain<Listed>;
template std::vector<int> pool(const Chain<InOrder>&, Arena&);
template std::vector<int> pool(const Chain<Listed>&, Arena&);
template std::vector<int> pool_carefully(const Chain<InOrder>&, Index, Index,
                                         const std::function<DoubleDouble(Index)>&);
template std::vector<int> pool_carefully(const Chain<Listed>&, Index, Index,
                                         const std::function<DoubleDouble(Index)>&);

}  // namespace convex::inline isotonic
