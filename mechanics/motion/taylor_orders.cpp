#include "mechanics/motion/taylor_orders.hpp"

#include <algorithm>

#include "convex/processor.hpp"

namespace mechanics::inline motions {
namespace {

// Products and sums may be fused from here on, as in the dense kernels.
#pragma GCC push_options
#pragma GCC optimize("fp-contract=fast")

/// So many blocks of a matrix times the inputs of an order. Several sums each, so that an addition need not
/// wait for the one before.
template <std::size_t blocks>
[[gnu::always_inline]] inline void multiply_blocks(const TaylorOrders& all, std::size_t first, Wide* to) {
  constexpr std::size_t sums = blocks <= 2 ? 4 : 2;
  Wide sum[sums][blocks];
  for (auto& each : sum)
    for (Wide& of : each) of = Wide{};
  const std::size_t stride = all.blocks;
  const double* w = reinterpret_cast<const double*>(all.input);
  const Wide* column = all.of_moving + first;
  for (std::size_t i = 0; i < all.moving; i += 2, column += 2 * stride)  // an even number
    for (std::size_t s = 0; s < 2; ++s)
      for (std::size_t b = 0; b < blocks; ++b) sum[s][b] += w[i + s] * column[s * stride + b];
  w += all.moving_blocks * Eight::count;
  column = all.of_rests + first;
  std::size_t i = 0;
  for (; i + sums <= all.products; i += sums, column += sums * stride)
    for (std::size_t s = 0; s < sums; ++s)
      for (std::size_t b = 0; b < blocks; ++b) sum[(s + 2) % sums][b] += w[i + s] * column[s * stride + b];
  for (; i < all.products; ++i, column += stride)
    for (std::size_t b = 0; b < blocks; ++b) sum[0][b] += w[i] * column[b];
  for (std::size_t b = 0; b < blocks; ++b) {
    to[b] = sum[0][b] + sum[1][b];
    if constexpr (sums == 4) to[b] += sum[2][b] + sum[3][b];
  }
}

[[gnu::always_inline]] inline void multiply_all(const TaylorOrders& all, Wide* to) {
  std::size_t first = 0;
  for (; all.blocks - first > 6; first += 4) multiply_blocks<4>(all, first, to + first);
  switch (all.blocks - first) {
    case 1:
      return multiply_blocks<1>(all, first, to + first);
    case 2:
      return multiply_blocks<2>(all, first, to + first);
    case 3:
      return multiply_blocks<3>(all, first, to + first);
    case 4:
      return multiply_blocks<4>(all, first, to + first);
    case 5:
      return multiply_blocks<5>(all, first, to + first);
    default:
      return multiply_blocks<6>(all, first, to + first);
  }
}

/// Σ_(j=2)^(k-1) x_j y_(k-j) of this order and of the next, of which x_k is not known yet: what both need is
/// read once. Zeros are where there is no order, so that several can be taken at a time.
template <std::size_t blocks>
[[gnu::always_inline]] inline void sum_old(const TaylorOrders& all, std::size_t first, std::size_t k,
                                           Wide* of_this, Wide* of_next) {
  constexpr std::size_t at_once = 4;
  const std::size_t width = all.width();
  const Wide* x = all.x + first * width;
  const Wide* y = all.y + first * width + TaylorOrders::zeros + k;
  Wide now[2][blocks], then[2][blocks];
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t b = 0; b < blocks; ++b) now[i][b] = then[i][b] = Wide{};
  for (std::size_t j = 2; j < k; j += at_once)
    for (std::size_t b = 0; b < blocks; ++b) {
      const Wide* of_x = x + b * width + j;
      const Wide* of_y = y + b * width - j;
      Wide after = of_y[1];
      for (std::size_t i = 0; i < at_once; ++i) {
        const Wide here = *(of_y - i), factor = of_x[i];
        now[i % 2][b] += factor * here;
        then[i % 2][b] += factor * after;
        after = here;
      }
    }
  for (std::size_t b = 0; b < blocks; ++b) {
    of_this[first + b] = now[0][b] + now[1][b];
    of_next[first + b] = then[0][b] + then[1][b];
  }
}

[[gnu::always_inline]] inline bool blocks_are_zero(const Wide* x, std::size_t blocks) {
  Places bits{};
  for (std::size_t b = 0; b < blocks; ++b)
    bits |= reinterpret_cast<const Places&>(x[b]) << 1;  // but for signs
  long long all = 0;
  for (std::size_t lane = 0; lane < Eight::count; ++lane) all |= bits[lane];
  return all == 0;
}

/// Factors from the numbers, by one instruction where two blocks of them are all.
template <std::size_t blocks>
[[gnu::always_inline]] inline void pick(const Wide* numbers, const Places& place, Wide& to) {
#ifndef __clang__
  if constexpr (blocks == 1) {
    to = __builtin_shuffle(numbers[0], place);
    return;
  } else if constexpr (blocks == 2) {
    to = __builtin_shuffle(numbers[0], numbers[1], place);
    return;
  }
#endif
  const double* of = reinterpret_cast<const double*>(numbers);
  to = Wide{of[place[0]], of[place[1]], of[place[2]], of[place[3]],
            of[place[4]], of[place[5]], of[place[6]], of[place[7]]};
}

constexpr std::size_t most_blocks = 64;

/// R of order k. of_old: the sum of its old terms.
[[gnu::always_inline]] inline void find_rests(const TaylorOrders& all, std::size_t k, const Wide* of_old,
                                              bool has_newest_x) {
  const std::size_t width = all.width();
  for (std::size_t b = 0; b < all.product_blocks; ++b) {
    const Wide* x = all.x + b * width;
    const Wide* y = all.y + b * width + TaylorOrders::zeros;
    Wide sum = of_old[b] + x[1] * y[k - 1];  // at k = 1 a zero
    if (has_newest_x) sum += x[k - 1] * y[1];
    const Wide zero{}, share = all.weighted[b] > zero ? zero + all.part[k] : zero + 1.0;
    const Wide rest_of_share = all.weighted[b] > zero ? zero + all.rest_of_part[k] : zero;
    all.input[all.moving_blocks + b] = sum * share + sum * rest_of_share;
  }
}

/// known, known_products: how many blocks there are, as constants; known = 0 where they are more. With
/// nothing above order d, products of lower orders are 0 above order 2d: then all the rest is 0. Without
/// products it is so at once.
template <std::size_t known, std::size_t known_products>
[[gnu::always_inline]] inline std::size_t find_orders_of(const TaylorOrders& of, bool& all_finite) {
  TaylorOrders all = of;
  if constexpr (known > 0) {
    all.moving_blocks = 1;
    all.blocks = known;
    all.product_blocks = known_products;
  }
  const std::size_t width = all.width();
  std::size_t degree = 1;
  Wide found[known > 0 ? known : most_blocks], spoiled{};  // 0 times a number, unless it is not finite
  constexpr std::size_t most_products = known > 0 ? std::max<std::size_t>(known_products, 1) : most_blocks;
  Wide old[most_products], next[most_products];
  for (std::size_t b = 0; b < all.product_blocks; ++b)
    for (std::size_t j = 0; j <= TaylorOrders::zeros; ++j) all.x[b * width + j] = Wide{};
  const auto take_velocities = [&](std::size_t k) __attribute__((always_inline)) {
    const Wide* last = all.numbers + (k - 1) * all.blocks;
    for (std::size_t b = 0; b < all.moving_blocks; ++b)
      all.input[b] = last[b] * all.part[k] + last[b] * all.rest_of_part[k];
  };
  const auto has_ended = [&](std::size_t k) __attribute__((always_inline)) {
    if (k > 1 && blocks_are_zero(all.input, all.moving_blocks + all.product_blocks))
      return all.product_blocks == 0 || 2 * degree + 1 < k;
    degree = k;
    return false;
  };
  const auto find = [&](std::size_t k) __attribute__((always_inline)) {
    if constexpr (known > 0)
      multiply_blocks<known>(all, 0, found);
    else
      multiply_all(all, found);
    if (k == 1)
      for (std::size_t b = 0; b < all.blocks; ++b) found[b] += all.of_time[b];
    for (std::size_t b = 0; b < all.blocks; ++b) {
      all.numbers[k * all.blocks + b] = found[b];
      spoiled += 0.0 * found[b];
    }
    const double more = static_cast<double>(k) - 1;
    for (std::size_t b = 0; b < all.product_blocks; ++b) {
      Wide x, y;
      pick<known>(found, all.place_of_x[b], x);
      pick<known>(found, all.place_of_y[b], y);
      all.x[b * width + k] = x * (1.0 + more * all.weighted[b]);
      all.x[b * width + k + TaylorOrders::zeros] = Wide{};
      all.y[b * width + TaylorOrders::zeros + k] = y;
    }
  };
  std::size_t k = 1;
  for (; k < all.count; ++k) {
    if constexpr (known_products > 0)
      sum_old<known_products>(all, 0, k, old, next);
    else if constexpr (known == 0)
      for (std::size_t b = 0; b < all.product_blocks; ++b) sum_old<1>(all, b, k, old, next);
    take_velocities(k);
    find_rests(all, k, old, false);
    if (has_ended(k)) break;
    find(k);
    if (++k == all.count) break;
    take_velocities(k);
    find_rests(all, k, next, k > 2);
    if (has_ended(k)) break;
    find(k);
  }
  const double* each = reinterpret_cast<const double*>(&spoiled);
  for (std::size_t lane = 0; lane < Eight::count; ++lane) all_finite = all_finite && each[lane] == 0;
  return k;
}

}  // namespace

MOREAU_CLONES std::size_t find_orders(const TaylorOrders& of, bool& all_finite) {
  if (of.moving_blocks == 1 && of.blocks == 1) {
    if (of.product_blocks == 0) return find_orders_of<1, 0>(of, all_finite);
    if (of.product_blocks == 1) return find_orders_of<1, 1>(of, all_finite);
  }
  if (of.moving_blocks == 1 && of.blocks == 2) {
    if (of.product_blocks == 0) return find_orders_of<2, 0>(of, all_finite);
    if (of.product_blocks == 1) return find_orders_of<2, 1>(of, all_finite);
    if (of.product_blocks == 2) return find_orders_of<2, 2>(of, all_finite);
  }
  return find_orders_of<0, 0>(of, all_finite);
}

#pragma GCC pop_options

}  // namespace mechanics::inline motions
