#pragma once

#include <algorithm>

#include "convex/dense/packs.hpp"
#include "mechanics/motion/taylor_orders.hpp"

namespace mechanics::inline motions {

/// All orders of a `TaylorRecurrence` in registers of W doubles; with so many blocks of numbers and of
/// products, as constants; none where they are more.
template <int W, std::size_t known, std::size_t known_products>
struct TaylorOrderSteps {
  using P = convex::Packs<W, true>;
  using Pack = typename P::Pack;
  static constexpr std::size_t eight = Eight::count;
  /// As many blocks of a sum as registers hold beside what is added to them.
  static constexpr std::size_t most_at_once = W == 8 ? 6 : W == 4 ? 3 : 2;
  static constexpr std::size_t at_a_time = W == 8 ? 4 : most_at_once;

  MOREAU_INLINE Pack constant(double c) {
    Pack pack;
    for (int k = 0; k < P::parts; ++k) pack.part[k] = c - typename P::Part{};
    return pack;
  }

  /// So many blocks of a matrix times the inputs of an order. Several sums each, so that an addition need not
  /// wait for the one before; the inputs known last come last.
  template <std::size_t blocks>
  MOREAU_INLINE void multiply_blocks(const TaylorOrders& all, std::size_t first, Pack (&product)[blocks]) {
    constexpr std::size_t sums = W == 8 && blocks <= 2 ? 4 : W == 2 && blocks == 2 ? 1 : 2;
    Pack sum[sums][blocks];
#pragma GCC unroll 4
    for (std::size_t s = 0; s < sums; ++s) P::clear(sum[s]);
    const std::size_t stride = all.blocks * eight;
    const auto add = [&](Pack(&to_sum)[blocks], double w, const double* column)
        __attribute__((always_inline)) {
#pragma GCC unroll 6
      for (std::size_t b = 0; b < blocks; ++b) P::add_product(to_sum[b], P::load(column + b * eight), w);
    };
    const double* w = all.input;
    const double* column = all.of_moving + first * eight;
    for (std::size_t i = 0; i < all.moving; i += 2, column += 2 * stride) {  // an even number
      add(sum[0], w[i], column);
      add(sum[sums > 1 ? 1 : 0], w[i + 1], column + stride);
    }
    w += all.moving_blocks * eight;
    column = all.of_rests + first * eight;
    std::size_t i = 0;
    for (; i + sums <= all.products; i += sums, column += sums * stride)
#pragma GCC unroll 4
      for (std::size_t s = 0; s < sums; ++s) add(sum[(s + 2) % sums], w[i + s], column + s * stride);
#pragma GCC unroll 3
    for (std::size_t s = 0; s + 1 < sums; ++s, ++i, column += stride) {
      if (i >= all.products) break;
      add(sum[(s + 2) % sums], w[i], column);
    }
#pragma GCC unroll 6
    for (std::size_t b = 0; b < blocks; ++b) {
      product[b] = sum[0][b];
      if constexpr (sums > 1) product[b] = P::plus(product[b], sum[1][b]);
      if constexpr (sums == 4) product[b] = P::plus(product[b], P::plus(sum[2][b], sum[3][b]));
    }
  }

  template <std::size_t blocks>
  MOREAU_INLINE void store_blocks(const TaylorOrders& all, std::size_t first, double* to) {
    Pack product[blocks];
    multiply_blocks<blocks>(all, first, product);
#pragma GCC unroll 6
    for (std::size_t b = 0; b < blocks; ++b) P::store(to + (first + b) * eight, product[b]);
  }

  template <std::size_t blocks>
  MOREAU_INLINE void multiply_last(const TaylorOrders& all, std::size_t first, double* to) {
    if constexpr (blocks > 0) {
      if (all.blocks - first == blocks) return store_blocks<blocks>(all, first, to);
      multiply_last<blocks - 1>(all, first, to);
    }
  }

  MOREAU_INLINE void multiply_all(const TaylorOrders& all, double* to) {
    std::size_t first = 0;
    for (; all.blocks - first > most_at_once; first += at_a_time) store_blocks<at_a_time>(all, first, to);
    multiply_last<most_at_once>(all, first, to);
  }

  /// To be read into registers once: GCC reads it again for each product. Clang checks registers before the
  /// function is in one that has them.
  MOREAU_INLINE void hold(Pack& pack) {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
    for (int k = 0; k < P::parts; ++k)
      if constexpr (W == 8)
        asm("" : "+v"(pack.part[k]));
      else
        asm("" : "+x"(pack.part[k]));
#endif
  }

  /// Σ_j x_j y_(k-j) of this order and of the next over orders below k - 1: what both need is read once.
  /// Zeros are where there is no order yet, so that several can be taken at a time.
  MOREAU_INLINE void sum_old(const TaylorOrders& all, std::size_t b, std::size_t k, Pack& of_this,
                             Pack& of_next) {
    constexpr std::size_t at_once = 4;
    const double* x = all.x + (b * all.width()) * eight;
    const double* y = all.y + (b * all.width() + TaylorOrders::zeros + k) * eight;
    Pack now[2], then[2];
    P::clear(now);
    P::clear(then);
    for (std::size_t j = 2; j + 1 < k; j += at_once) {
      Pack after = P::load(y - (j - 1) * eight);
#pragma GCC unroll 4
      for (std::size_t i = 0; i < at_once; ++i) {
        const Pack here = P::load(y - (j + i) * eight);
        Pack factor = P::load(x + (j + i) * eight);
        hold(factor);
        P::add_products(now[i % 2], factor, here);
        P::add_products(then[i % 2], factor, after);
        after = here;
      }
    }
    of_this = P::plus(now[0], now[1]);
    of_next = P::plus(then[0], then[1]);
  }

  /// Whether the numbers of an order stay in registers while the next order is begun.
  static constexpr bool are_held = known > 0 && known <= most_at_once;

  /// Factors from the numbers.
  MOREAU_INLINE Pack pick(const double* numbers, const Places& place) {
    Pack to;
    for (int k = 0; k < P::parts; ++k)
      for (int l = 0; l < W; ++l) to.part[k][l] = numbers[place.of[k * W + l]];
    return to;
  }
#ifndef __clang__
  /// The same by one instruction, where two blocks are all.
  MOREAU_INLINE Pack shuffled(const Pack (&held)[known > 0 ? known : 1], const Places& place) {
    using Whole [[gnu::vector_size(64), gnu::may_alias]] = long long;
    Whole from;
    std::memcpy(&from, place.of, sizeof from);
    Pack to;
    if constexpr (known == 1)
      to.part[0] = __builtin_shuffle(held[0].part[0], from);
    else
      to.part[0] = __builtin_shuffle(held[0].part[0], held[1].part[0], from);
    return to;
  }
  static constexpr bool are_shuffled = W == 8 && (known == 1 || known == 2);
#else
  static constexpr bool are_shuffled = false;
#endif

  static constexpr std::size_t products_held = known > 0 ? std::max<std::size_t>(known_products, 1)
                                                         : TaylorOrders::most_blocks;
  /// By block of products: the newest factors, those of order k - 1, and sums of the terms without them.
  struct Newest {
    Pack x[products_held], y[products_held], old[products_held], next[products_held];
    Pack moving;  ///< velocities and forces of order k - 1, where numbers are held
  };

  MOREAU_INLINE Pack weight(const Pack& weighted, std::size_t order) {
    return P::plus(P::times(weighted, static_cast<double>(order) - 1), 1);
  }
  MOREAU_INLINE void put(const TaylorOrders& all, std::size_t b, std::size_t order, const Pack& x,
                         const Pack& y) {
    constexpr std::size_t zeros = TaylorOrders::zeros;
    const Pack zero = constant(0);
    double* to_x = all.x + (b * all.width() + order) * eight;
    double* to_y = all.y + (b * all.width() + zeros + order) * eight;
    P::store(to_x, P::times(x, weight(P::load(all.weighted + b * eight), order)));
    P::store(to_x + zeros * eight, zero);
    P::store(to_y, y);
    P::store(to_y + zeros * eight, zero);
  }

  /// What orders k and k + 1 have from orders below k - 1; then those of order k - 1 are put to the others.
  MOREAU_INLINE void begin_pair(const TaylorOrders& all, std::size_t k, Newest& of) {
#pragma GCC unroll 2
    for (std::size_t b = 0; b < all.product_blocks; ++b) {
      sum_old(all, b, k, of.old[b], of.next[b]);
      if (k < 3) continue;
      const Pack x = P::times(of.x[b], weight(P::load(all.weighted + b * eight), k - 1));
      if (k == 3) {
        P::add_products(of.next[b], x, of.y[b]);
      } else {
        P::add_products(of.next[b], P::load(all.x + (b * all.width() + 2) * eight), of.y[b]);
        P::add_products(of.next[b], x, P::load(all.y + (b * all.width() + TaylorOrders::zeros + 2) * eight));
      }
      put(all, b, k - 1, of.x[b], of.y[b]);
    }
  }

  /// R of order k > 1: the terms with the newest factors come last, x_1 y_(k-1) and x_(k-1) y_1 with the
  /// share of each, (1 or k - 1) / k.
  MOREAU_INLINE void find_rests(const TaylorOrders& all, std::size_t k, const Pack* old, const Newest& of) {
#pragma GCC unroll 2
    for (std::size_t b = 0; b < all.product_blocks; ++b) {
      const Pack weighted = P::load(all.weighted + b * eight);
      // 1 / k where there is a weight, else 1; both exactly.
      const Pack share = P::plus(P::times(weighted, all.part[k]), P::minus(constant(1), weighted));
      const Pack rest_of_share = P::times(weighted, all.rest_of_part[k]);
      const auto shared = [&](const Pack& x) __attribute__((always_inline)) {
        Pack part = P::times(x, rest_of_share);
        P::add_products(part, x, share);
        return part;
      };
      Pack sum = shared(old[b]);
      P::add_products(sum, shared(k > 2 ? P::load(all.x + (b * all.width() + 1) * eight) : of.x[b]), of.y[b]);
      if (k > 2) {
        const Pack first = P::load(all.y + (b * all.width() + TaylorOrders::zeros + 1) * eight);
        P::add_products(sum, shared(P::times(first, weight(weighted, k - 1))), of.x[b]);
      }
      P::store(all.input + (all.moving_blocks + b) * eight, sum);
    }
  }

  MOREAU_INLINE void take_velocities(const TaylorOrders& all, std::size_t k, const Newest& of) {
    const double* last = all.numbers + (k - 1) * all.blocks * eight;
    for (std::size_t b = 0; b < all.moving_blocks; ++b) {
      Pack v;
      if constexpr (are_held)
        v = of.moving;
      else
        v = P::load(last + b * eight);
      Pack part = P::times(v, all.rest_of_part[k]);
      P::add_product(part, v, all.part[k]);
      P::store(all.input + b * eight, part);
    }
  }

  /// With nothing above order d, products of lower orders are 0 above order 2d: then all the rest is 0.
  /// Without products it is so at once.
  MOREAU_INLINE bool has_ended(const TaylorOrders& all, std::size_t k, std::size_t& degree) {
    const std::size_t count = (all.moving_blocks + all.product_blocks) * eight;
    std::size_t i = 0;
    while (i < count && all.input[i] == 0) ++i;
    if (i == count && k > 1) return all.product_blocks == 0 || 2 * degree + 1 < k;
    degree = k;
    return false;
  }

  MOREAU_INLINE void find_numbers(const TaylorOrders& all, std::size_t k, Pack& spoiled, Newest& of) {
    double* found = all.numbers + k * all.blocks * eight;
    if constexpr (are_held) {
      Pack held[known];
      multiply_blocks<known>(all, 0, held);
#pragma GCC unroll 6
      for (std::size_t b = 0; b < known; ++b) {
        if (k == 1) held[b] = P::plus(held[b], P::load(all.of_time + b * eight));
        P::store(found + b * eight, held[b]);
        P::add_product(spoiled, held[b], 0);
      }
      of.moving = held[0];
      if constexpr (are_shuffled) {
#pragma GCC unroll 2
        for (std::size_t b = 0; b < all.product_blocks; ++b) {
          of.x[b] = shuffled(held, all.place_of_x[b]);
          of.y[b] = shuffled(held, all.place_of_y[b]);
        }
        return;
      }
    } else {
      multiply_all(all, found);
      for (std::size_t b = 0; b < all.blocks; ++b) {
        Pack number = P::load(found + b * eight);
        if (k == 1) {
          number = P::plus(number, P::load(all.of_time + b * eight));
          P::store(found + b * eight, number);
        }
        P::add_product(spoiled, number, 0);
      }
    }
#pragma GCC unroll 2
    for (std::size_t b = 0; b < all.product_blocks; ++b) {
      of.x[b] = pick(found, all.place_of_x[b]);
      of.y[b] = pick(found, all.place_of_y[b]);
    }
  }

  /// Orders 1 to count - 1, from that of 0. Returns the first one from which on all are 0.
  MOREAU_INLINE std::size_t find(const TaylorOrders& of, bool& all_finite) {
    TaylorOrders all = of;
    if constexpr (known > 0) {
      all.moving_blocks = 1;
      all.blocks = known;
      all.product_blocks = known_products;
    }
    Newest newest;
    newest.moving = P::load(all.numbers);
    const Pack zero = constant(0);
    Pack spoiled = constant(0);  // 0 times a number, unless it is not finite
    for (std::size_t b = 0; b < all.product_blocks; ++b) {
      for (std::size_t j = 0; j <= TaylorOrders::zeros; ++j) {
        P::store(all.x + (b * all.width() + j) * eight, zero);
        P::store(all.y + (b * all.width() + TaylorOrders::zeros + j) * eight, zero);
      }
      P::store(all.input + (all.moving_blocks + b) * eight, zero);
    }
    std::size_t degree = 1, k = 1;
    for (; k < all.count; ++k) {
      take_velocities(all, k, newest);
      begin_pair(all, k, newest);
      if (k > 1) find_rests(all, k, newest.old, newest);
      if (has_ended(all, k, degree)) break;
      find_numbers(all, k, spoiled, newest);
      for (std::size_t b = 0; b < all.product_blocks; ++b) put(all, b, k, newest.x[b], newest.y[b]);
      if (++k == all.count) break;
      take_velocities(all, k, newest);
      find_rests(all, k, newest.next, newest);
      if (has_ended(all, k, degree)) break;
      find_numbers(all, k, spoiled, newest);
    }
    double each[eight];
    P::store(each, spoiled);
    for (const double lane : each) all_finite = all_finite && lane == 0;
    return k;
  }
};

}  // namespace mechanics::inline motions
