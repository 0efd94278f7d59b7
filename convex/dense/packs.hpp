#pragma once

#include <cstring>
#include <utility>

#include "convex/dense/compiled.hpp"
#include "convex/dense/dense_kernels.hpp"
#include "convex/dense/registers.hpp"

namespace convex::inline dense {

/// Eight doubles in registers of W, and what is done with them entry by entry, so that results do not depend
/// on W. Fused: whether the machine has a fused multiply-add, by which the rounding of a product is found; it
/// is the same number either way.
template <int W, bool Fused>
struct Packs {
  using Part = typename Register<W>::Doubles;
  using Wholes = typename Register<W>::Wholes;
  static constexpr int parts = 8 / W, width = W;
  struct Pack {
    Part part[parts];
  };

  // Part by part: a copy of the whole would go by the words of the smallest machine, through memory.
  MOREAU_INLINE Pack load(const double* x) {
    Pack pack;
    for (int k = 0; k < parts; ++k) std::memcpy(&pack.part[k], x + k * W, sizeof(Part));
    return pack;
  }
  MOREAU_INLINE void store(double* x, const Pack& pack) {
    for (int k = 0; k < parts; ++k) std::memcpy(x + k * W, &pack.part[k], sizeof(Part));
  }
  /// Only what lies before `end` may be read; zeros stand for the rest.
  MOREAU_INLINE Pack load_before(const double* x, const double* end) {
    if (end - x >= 8) return load(x);
    if constexpr (W == 8) {  // what a mask leaves out is not read
      Pack pack;
      const auto mask = static_cast<unsigned short>(end > x ? (1U << (end - x)) - 1 : 0);
      asm("vmovupd %2, %0%{%1%}%{z%}"
          : "=v"(pack.part[0])
          : "Yk"(mask), "m"(*reinterpret_cast<const double(*)[8]>(x)));
      return pack;
    }
    if constexpr (W == 4) {
      alignas(64) static constexpr long long inside[16] = {-1, -1, -1, -1, -1, -1, -1, -1};
      const long long* const mask = inside + (end > x ? 8 - (end - x) : 8);
      Pack pack;
      for (int k = 0; k < parts; ++k) {
        Wholes some;
        std::memcpy(&some, mask + k * W, sizeof(Wholes));
        asm("vmaskmovpd %2, %1, %0"
            : "=x"(pack.part[k])
            : "x"(some), "m"(*reinterpret_cast<const double(*)[W]>(x + k * W)));
      }
      return pack;
    }
    double tail[8] = {};
    for (Index i = 0; i < end - x; ++i) tail[i] = x[i];
    return load(tail);
  }
  /// The first `count` entries of x, then zeros.
  MOREAU_INLINE Pack first(const Pack& x, Index count) {
    alignas(64) static constexpr double inside[16] = {1, 1, 1, 1, 1, 1, 1, 1};
    return count >= 8 ? x : where_larger(load(inside + 8 - count), 0, x, 0);
  }
  /// Sets each of an array of packs to 0; `Pack sum[8] = {}` would go through memory.
  template <int count>
  MOREAU_INLINE void clear(Pack (&x)[count]) {
#pragma GCC unroll 8
    for (int r = 0; r < count; ++r)
      for (int k = 0; k < parts; ++k) x[r].part[k] = Part{};
  }
  MOREAU_INLINE Pack times(const Pack& x, double c) {
    Pack product;
    for (int k = 0; k < parts; ++k) product.part[k] = x.part[k] * c;
    return product;
  }
  MOREAU_INLINE Pack times(const Pack& x, const Pack& y) {
    Pack product;
    for (int k = 0; k < parts; ++k) product.part[k] = x.part[k] * y.part[k];
    return product;
  }
  MOREAU_INLINE Pack plus(const Pack& x, const Pack& y) {
    Pack sum;
    for (int k = 0; k < parts; ++k) sum.part[k] = x.part[k] + y.part[k];
    return sum;
  }
  MOREAU_INLINE Pack minus(const Pack& x, const Pack& y) {
    Pack difference;
    for (int k = 0; k < parts; ++k) difference.part[k] = x.part[k] - y.part[k];
    return difference;
  }
  MOREAU_INLINE Pack larger(const Pack& x, const Pack& y) {
    Pack most;
    for (int k = 0; k < parts; ++k) most.part[k] = x.part[k] > y.part[k] ? x.part[k] : y.part[k];
    return most;
  }
  MOREAU_INLINE Pack size(const Pack& x) {
    Pack positive;
    for (int k = 0; k < parts; ++k)
      positive.part[k] = reinterpret_cast<Part>(reinterpret_cast<Wholes>(x.part[k]) & 0x7fffffffffffffffLL);
    return positive;
  }
  MOREAU_INLINE Pack smaller(const Pack& x, const Pack& y) {
    Pack least;
    for (int k = 0; k < parts; ++k) least.part[k] = x.part[k] < y.part[k] ? x.part[k] : y.part[k];
    return least;
  }
  MOREAU_INLINE Pack plus(const Pack& x, double c) {
    Pack sum;
    for (int k = 0; k < parts; ++k) sum.part[k] = x.part[k] + c;
    return sum;
  }
  MOREAU_INLINE Pack over(const Pack& x, const Pack& y) {
    Pack quotient;
    for (int k = 0; k < parts; ++k) quotient.part[k] = x.part[k] / y.part[k];
    return quotient;
  }
  MOREAU_INLINE Pack root(const Pack& x) {
    Pack found;
    for (int k = 0; k < parts; ++k)
      if constexpr (W == 8)
        asm("vsqrtpd %1, %0" : "=v"(found.part[k]) : "v"(x.part[k]));
      else if constexpr (W == 4)
        asm("vsqrtpd %1, %0" : "=x"(found.part[k]) : "x"(x.part[k]));
      else
        for (int i = 0; i < W; ++i) found.part[k][i] = __builtin_sqrt(x.part[k][i]);
    return found;
  }
  /// The places in part k, less i.
  MOREAU_INLINE Wholes places(int k, Index i) {
    alignas(64) static constexpr long long all[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    Wholes place;
    std::memcpy(&place, all + k * W, sizeof(Wholes));
    return place - static_cast<long long>(i);
  }
  /// x with `value` at place i, which may lie outside: then x.
  MOREAU_INLINE Pack with_entry(const Pack& x, Index i, double value) {
    Pack changed;
    for (int k = 0; k < parts; ++k) changed.part[k] = places(k, i) == 0 ? value - Part{} : x.part[k];
    return changed;
  }
  /// The entries of y before place i, those of x from there on.
  MOREAU_INLINE Pack joined(const Pack& y, const Pack& x, Index i) {
    Pack both;
    for (int k = 0; k < parts; ++k) both.part[k] = places(k, i) < 0 ? y.part[k] : x.part[k];
    return both;
  }
  /// Where x > c, y; otherwise `other`.
  MOREAU_INLINE Pack where_larger(const Pack& x, double c, const Pack& y, double other) {
    Pack chosen;
    for (int k = 0; k < parts; ++k) chosen.part[k] = x.part[k] > c ? y.part[k] : other - Part{};
    return chosen;
  }
  /// least := x where that is smaller, and there at := now.
  MOREAU_INLINE void keep_smaller(Pack& least, Pack& at, const Pack& x, const Pack& now) {
    for (int k = 0; k < parts; ++k) {
      const auto smaller = x.part[k] < least.part[k];
      least.part[k] = smaller ? x.part[k] : least.part[k];
      at.part[k] = smaller ? now.part[k] : at.part[k];
    }
  }
  /// 1 over the root of x within a thirtieth of it: half the exponent, read as a whole number (Lomont 2003).
  MOREAU_INLINE Pack halved_exponent(const Pack& x) {
    using Wholes [[gnu::vector_size(W * sizeof(double))]] = unsigned long long;
    Pack guess;
    for (int k = 0; k < parts; ++k)
      guess.part[k] =
          reinterpret_cast<Part>(0x5fe6eb50c7b537a9ULL - (reinterpret_cast<Wholes>(x.part[k]) >> 1));
    return guess;
  }
  MOREAU_INLINE void add_product(Pack& sum, const Pack& x, double c) {
    for (int k = 0; k < parts; ++k) sum.part[k] = sum.part[k] + x.part[k] * c;
  }
  MOREAU_INLINE void subtract_product(Pack& sum, const Pack& x, double c) {
    for (int k = 0; k < parts; ++k) sum.part[k] = sum.part[k] - x.part[k] * c;
  }
  MOREAU_INLINE void add_products(Pack& sum, const Pack& x, const Pack& y) {
    for (int k = 0; k < parts; ++k) sum.part[k] = sum.part[k] + x.part[k] * y.part[k];
  }
  /// Its halves by f, and theirs, until one number is left: ((0 4) (2 6)) ((1 5) (3 7)).
  template <class Combine>
  MOREAU_INLINE double folded(const Pack& x, Combine f) {
    if constexpr (W == 2) {
      const Part two = f(f(x.part[0], x.part[2]), f(x.part[1], x.part[3]));
      return f(two[0], two[1]);
    } else {
      using Four [[gnu::vector_size(32)]] = double;
      using Two [[gnu::vector_size(16)]] = double;
      Four four;
      if constexpr (W == 8)
        four = f(half_of<Four, 0>(x.part[0]), half_of<Four, 4>(x.part[0]));
      else
        four = f(x.part[0], x.part[1]);
      const Two two = f(half_of<Two, 0>(four), half_of<Two, 2>(four));
      return f(two[0], two[1]);
    }
  }
  MOREAU_INLINE double total(const Pack& x) {
    return folded(
        x, [](const auto& a, const auto& b) __attribute__((always_inline)) { return a + b; });
  }
  MOREAU_INLINE double largest(const Pack& x) {
    return folded(
        x, [](const auto& a, const auto& b) __attribute__((always_inline)) { return a > b ? a : b; });
  }
  /// The totals of eight packs, each as above.
  MOREAU_INLINE Pack totals(const Pack (&x)[8]) {
    if constexpr (W == 8) {
      using Places [[gnu::vector_size(64)]] = long long;
      constexpr Places low{0, 1, 2, 3, 8, 9, 10, 11}, high{4, 5, 6, 7, 12, 13, 14, 15};
      constexpr Places first{0, 1, 4, 5, 8, 9, 12, 13}, second{2, 3, 6, 7, 10, 11, 14, 15};
      constexpr Places even{0, 2, 4, 6, 8, 10, 12, 14}, odd{1, 3, 5, 7, 9, 11, 13, 15};
      const auto halved =
          [](const Part& a, const Part& b, const Places& p, const Places& q) __attribute__((always_inline)) {
        return __builtin_shuffle(a, b, p) + __builtin_shuffle(a, b, q);
      };
      Part half[4];
      for (int k = 0; k < 4; ++k) half[k] = halved(x[2 * k].part[0], x[2 * k + 1].part[0], low, high);
      return {{halved(halved(half[0], half[1], first, second), halved(half[2], half[3], first, second), even,
                      odd)}};
    } else if constexpr (W == 4) {
      constexpr Wholes low{0, 1, 4, 5}, high{2, 3, 6, 7}, even{0, 4, 2, 6}, odd{1, 5, 3, 7},
          apart{0, 2, 1, 3};
      Pack sums;
#pragma GCC unroll 2
      for (int k = 0; k < 2; ++k) {
        Part half[4], pair[2];
        for (int l = 0; l < 4; ++l) half[l] = x[4 * k + l].part[0] + x[4 * k + l].part[1];
        for (int l = 0; l < 2; ++l)
          pair[l] = __builtin_shuffle(half[2 * l], half[2 * l + 1], low) +
                    __builtin_shuffle(half[2 * l], half[2 * l + 1], high);
        sums.part[k] = __builtin_shuffle(
            __builtin_shuffle(pair[0], pair[1], even) + __builtin_shuffle(pair[0], pair[1], odd), apart);
      }
      return sums;
    } else {
      double sum[8];
      for (int k = 0; k < 8; ++k) sum[k] = total(x[k]);
      return load(sum);
    }
  }
  /// Four registers of four: rows become columns.
  MOREAU_INLINE void transpose_four(Part& a, Part& b, Part& c, Part& d) {
    constexpr Wholes even{0, 4, 2, 6}, odd{1, 5, 3, 7}, low{0, 1, 4, 5}, high{2, 3, 6, 7};
    const Part ab = __builtin_shuffle(a, b, even), ba = __builtin_shuffle(a, b, odd);
    const Part cd = __builtin_shuffle(c, d, even), dc = __builtin_shuffle(c, d, odd);
    a = __builtin_shuffle(ab, cd, low), c = __builtin_shuffle(ab, cd, high);
    b = __builtin_shuffle(ba, dc, low), d = __builtin_shuffle(ba, dc, high);
  }
  /// Rows become columns.
  MOREAU_INLINE void transpose(Pack (&x)[8]) {
    if constexpr (W == 8) {
      using Places [[gnu::vector_size(64)]] = long long;
      constexpr Places even{0, 8, 2, 10, 4, 12, 6, 14}, odd{1, 9, 3, 11, 5, 13, 7, 15};
      constexpr Places low_pairs{0, 1, 8, 9, 4, 5, 12, 13}, high_pairs{2, 3, 10, 11, 6, 7, 14, 15};
      constexpr Places low{0, 1, 2, 3, 8, 9, 10, 11}, high{4, 5, 6, 7, 12, 13, 14, 15};
      Part a[8], b[8];
#pragma GCC unroll 4
      for (int k = 0; k < 8; k += 2) {
        a[k] = __builtin_shuffle(x[k].part[0], x[k + 1].part[0], even);
        a[k + 1] = __builtin_shuffle(x[k].part[0], x[k + 1].part[0], odd);
      }
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) {
        const int p = k / 2 * 4 + k % 2;
        b[p] = __builtin_shuffle(a[p], a[p + 2], low_pairs);
        b[p + 2] = __builtin_shuffle(a[p], a[p + 2], high_pairs);
      }
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) {
        x[k].part[0] = __builtin_shuffle(b[k], b[k + 4], low);
        x[k + 4].part[0] = __builtin_shuffle(b[k], b[k + 4], high);
      }
    } else if constexpr (W == 4) {
#pragma GCC unroll 4
      for (int b = 0; b < 4; ++b)
        transpose_four(x[b / 2 * 4].part[b % 2], x[b / 2 * 4 + 1].part[b % 2], x[b / 2 * 4 + 2].part[b % 2],
                       x[b / 2 * 4 + 3].part[b % 2]);
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) std::swap(x[k].part[1], x[4 + k].part[0]);
    } else {
      double from[64], into[64];
      for (int k = 0; k < 8; ++k) store(from + 8 * k, x[k]);
      for (int k = 0; k < 8; ++k)
        for (int l = 0; l < 8; ++l) into[8 * k + l] = from[8 * l + k];
      for (int k = 0; k < 8; ++k) x[k] = load(into + 8 * k);
    }
  }
  /// Σ_c columns[8c…] y_c, eight columns.
  MOREAU_INLINE Pack block_times(const double* columns, const double* y) {
    Pack a = times(load(columns), y[0]), b = times(load(columns + 8), y[1]);
    for (int c = 2; c < 8; c += 2) {
      add_product(a, load(columns + 8 * c), y[c]);
      add_product(b, load(columns + 8 * c + 8), y[c + 1]);
    }
    return plus(a, b);
  }

  /// a c - b rounded once. Written in the machine's own words: there is no other that a function compiled for
  /// several machines may use, and entry by entry it is several times slower.
  MOREAU_INLINE Part fused_difference(Part a, const Part& c, const Part& b) {
    if constexpr (W == 8)
      asm("vfmsub132pd %2, %1, %0" : "+v"(a) : "v"(b), "v"(c));
    else
      asm("vfmsub132pd %2, %1, %0" : "+x"(a) : "x"(b), "x"(c));
    return a;
  }

  /// x := x + y rounded; what rounding takes away (Knuth 1969).
  MOREAU_INLINE Pack two_sum(Pack& x, const Pack& y) {
    Pack rest;
    for (int k = 0; k < parts; ++k) {
      const Part sum = x.part[k] + y.part[k], grown = sum - x.part[k];
      rest.part[k] = (x.part[k] - (sum - grown)) + (y.part[k] - grown);
      x.part[k] = sum;
    }
    return rest;
  }

  /// hi + lo += x c in twice the working precision (Ogita, Rump and Oishi 2005; Dekker 1971 for the product).
  MOREAU_INLINE void add_precisely(Pack& hi, Pack& lo, const Pack& x, double c) {
    for (int k = 0; k < parts; ++k) {
      const Part a = x.part[k], product = a * c;
      Part error;
      if constexpr (Fused) {
        error = fused_difference(a, c - Part{}, product);
      } else {
        constexpr double splitter = 0x1p27 + 1;
        const Part ca = splitter * a, a_high = ca - (ca - a), a_low = a - a_high;
        const double cc = splitter * c, c_high = cc - (cc - c), c_low = c - c_high;
        error = a_low * c_low - (((product - a_high * c_high) - a_low * c_high) - a_high * c_low);
      }
      const Part sum = hi.part[k] + product, grown = sum - hi.part[k];
      lo.part[k] = lo.part[k] + (((hi.part[k] - (sum - grown)) + (product - grown)) + error);
      hi.part[k] = sum;
    }
  }
};

}  // namespace convex::inline dense
