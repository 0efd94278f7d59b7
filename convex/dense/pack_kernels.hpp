#pragma once

#include <cmath>
#include <type_traits>

#include "convex/dense/row_kernels.hpp"
#include "convex/dense/triangle_kernels.hpp"

namespace convex::inline dense {

/// The kernels of `DenseKernels`, to be compiled for a processor family each.
template <int W, bool Fused>
struct Kernels : TriangleKernels<W, Fused>, RowKernels<W, Fused> {
  using P = Packs<W, Fused>;
  using Pack = typename P::Pack;
  using RowKernels<W, Fused>::rows;

  MOREAU_INLINE void gram(Index n, const double* X, const double* Y, double* into, Index stride) {
    constexpr Index together = W == 8 ? 8 : 4;
    for (Index first = 0; first < 8; first += together) {
      Pack sum[together];
      P::clear(sum);
      for (Index i = 0; i < n; ++i) {
        const Pack x = P::load(X + 8 * i);
#pragma GCC unroll 8
        for (Index l = 0; l < together; ++l) P::add_product(sum[l], x, Y[8 * i + first + l]);
      }
#pragma GCC unroll 8
      for (Index l = 0; l < together; ++l) P::store(into + (first + l) * stride, sum[l]);
    }
  }

  MOREAU_INLINE void dots(Index n, const double* X, const double* y, double* into) {
    Pack sum[4];
    P::clear(sum);
    const auto add = [&](int k, Index i) __attribute__((always_inline)) {
      P::add_product(sum[k], P::load(X + 8 * i), y[i]);
    };
    Index i = 0;
    for (; i + 4 <= n; i += 4)
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) add(k, i + k);
    if (i < n) add(0, i);
    if (i + 1 < n) add(1, i + 1);
    if (i + 2 < n) add(2, i + 2);
    P::store(into, P::plus(P::plus(sum[0], sum[2]), P::plus(sum[1], sum[3])));
  }

  MOREAU_INLINE void combine(Index n, Index count, const double* X, const double* y, double* w) {
    Index i = 0;
    for (; i + 8 <= n && W == 8; i += 8) {
      Pack sum[8];
      P::clear(sum);
      for (Index k = 0; k < count; ++k) {
        const Pack factor = P::load(y + 8 * k);
#pragma GCC unroll 8
        for (int r = 0; r < 8; ++r) P::add_products(sum[r], P::load(X + 8 * (k * n + i + r)), factor);
      }
      P::store(w + i, P::plus(P::load(w + i), P::totals(sum)));
    }
    for (; i < n; ++i) {
      Pack sum{};
      for (Index k = 0; k < count; ++k)
        P::add_products(sum, P::load(X + 8 * (k * n + i)), P::load(y + 8 * k));
      w[i] += P::total(sum);
    }
  }

  MOREAU_INLINE void add_multiple(Index n, double c, const double* x, double* y) {
    for (Index i = 0; i < n; i += 8) {
      Pack sum = P::load(y + i);
      P::add_product(sum, P::load(x + i), c);
      P::store(y + i, sum);
    }
  }

  MOREAU_INLINE double dot(Index n, const double* x, const double* y) {
    Pack sum{};
    for (Index i = 0; i < n; i += 8) P::add_products(sum, P::load(x + i), P::load(y + i));
    return P::total(sum);
  }

  MOREAU_INLINE void stationarity(Index n, const double* A, const double* q, Index m, const double* U,
                                  Index count, const Index* rows, const double* lambda, const double* z,
                                  double* into) {
    Index i = 0;
    for (; i + 8 <= n; i += 8) {
      Pack hi = P::load(z + i), lo{};
      for (Index k = 0; k < count; ++k) P::add_precisely(hi, lo, P::load(U + rows[k] * n + i), lambda[k]);
      for (Index j = 0; j < n; ++j) P::add_precisely(hi, lo, P::load(A + j * n + i), -q[j]);
      P::store(into + i, P::plus(hi, lo));
    }
    if (i == n) return;
    const double *const end_of_A = A + n * n, *const end_of_U = U + m * n;
    Pack hi = P::load(z + i), lo{};
    for (Index k = 0; k < count; ++k)
      P::add_precisely(hi, lo, P::load_before(U + rows[k] * n + i, end_of_U), lambda[k]);
    for (Index j = 0; j < n; ++j) P::add_precisely(hi, lo, P::load_before(A + j * n + i, end_of_A), -q[j]);
    P::store(into + i, P::first(P::plus(hi, lo), n - i));
  }

  MOREAU_INLINE void residual(Index n, const double* A, const double* q, Index m, const double* U,
                              Index count, const Index* rows, const double* lambda, const double* z,
                              double* into) {
    const double *const end_of_A = A + n * n, *const end_of_U = U + m * n;
    const auto work = [&](Index i, auto together) __attribute__((always_inline)) {
      constexpr int packs = decltype(together)::value;
      // The last alone may reach beyond a row, and so beyond all.
      const auto load = [](const double* x, int r, const double* end) __attribute__((always_inline)) {
        return r < packs - 1 ? P::load(x + 8 * r) : P::load_before(x + 8 * r, end);
      };
      Pack applied[packs], product[packs];
#pragma GCC unroll 4
      for (int r = 0; r < packs; ++r) applied[r] = P::load(z + i + 8 * r);
      for (Index k = 0; k < count; ++k)
#pragma GCC unroll 4
        for (int r = 0; r < packs; ++r)
          P::add_product(applied[r], load(U + rows[k] * n + i, r, end_of_U), lambda[k]);
      P::clear(product);
      for (Index j = 0; j < n; ++j)
#pragma GCC unroll 4
        for (int r = 0; r < packs; ++r) P::add_product(product[r], load(A + j * n + i, r, end_of_A), q[j]);
#pragma GCC unroll 4
      for (int r = 0; r < packs; ++r)
        P::store(into + i + 8 * r, P::first(P::minus(applied[r], product[r]), n - i - 8 * r));
    };
    // Sums of several packs wait for themselves alone.
    Index i = 0;
    for (; i + 24 < n; i += 32) work(i, std::integral_constant<int, 4>());
    for (; i + 8 < n; i += 16) work(i, std::integral_constant<int, 2>());
    if (i < n) work(i, std::integral_constant<int, 1>());
  }

  MOREAU_INLINE void precise_slacks(Index n, const double* X, const double* q, const double* s,
                                    double* into) {
    Pack hi = P::times(P::load(s), -1), lo{};
    for (Index i = 0; i < n; ++i) P::add_precisely(hi, lo, P::load(X + 8 * i), q[i]);
    P::store(into, P::plus(hi, lo));
  }

  MOREAU_INLINE void add_columns(Index n, Index count, const Index* columns, const double* c, const double* X,
                                 Index stride, double* y) {
    Index i = 0;
    for (; i + 8 * rows <= n; i += 8 * rows) {
      Pack sum[rows];
#pragma GCC unroll 8
      for (int r = 0; r < rows; ++r) sum[r] = P::load(y + i + 8 * r);
      for (Index k = 0; k < count; ++k) {
        const double *const x = X + columns[k] * stride + i, factor = c[columns[k]];
#pragma GCC unroll 8
        for (int r = 0; r < rows; ++r) P::add_product(sum[r], P::load(x + 8 * r), factor);
      }
#pragma GCC unroll 8
      for (int r = 0; r < rows; ++r) P::store(y + i + 8 * r, sum[r]);
    }
    for (; i < n; i += 8) {
      Pack sum = P::load(y + i);
      for (Index k = 0; k < count; ++k)
        P::add_product(sum, P::load(X + columns[k] * stride + i), c[columns[k]]);
      P::store(y + i, sum);
    }
  }

  MOREAU_INLINE void side_by_side(Index n, Index m, const double* U, const Index* row, Index count,
                                  double* X) {
    const double* const end = U + m * n;
    for (Index i = 0; i < n; i += 8) {
      Pack block[8];
#pragma GCC unroll 8
      for (int k = 0; k < 8; ++k) block[k] = k < count ? P::load_before(U + row[k] * n + i, end) : Pack{};
      P::transpose(block);
#pragma GCC unroll 8
      for (int k = 0; k < 8; ++k)
        if (i + k < n) P::store(X + 8 * (i + k), block[k]);
    }
  }

  MOREAU_INLINE void whole_sums(Index n, const double* X, const double* s_of_X, const double* U,
                                const double* s, Index count, const Index* row, const double* length,
                                const double* least, double close, double* c, Index* terms, double* sizes,
                                double* rest, double* load) {
    constexpr double shift = 0x1.8p52, infinite = __builtin_inf();
    Pack sum = P::plus(Pack{}, 1), off{}, loads = P::minus(Pack{}, P::load(s_of_X));
    Index used = 0;  // of the rows, which are few where others are sums of some
    for (Index j = 0; j < count; ++j) {
      const Pack guess = P::load(c + 8 * j),
                 beyond = P::minus(P::times(P::size(guess), length[row[j]]), P::load(least)),
                 counted = P::where_larger(beyond, 0, guess, 0),
                 whole = P::plus(P::plus(counted, shift), -shift),
                 allowed = P::times(P::larger(P::size(counted), P::plus(Pack{}, 1)), close);
      off = P::larger(off, P::minus(P::size(P::minus(counted, whole)), allowed));
      sum = P::plus(sum, P::size(whole));
      P::add_product(loads, whole, s[row[j]]);
      P::store(c + 8 * used, whole);
      terms[used] = row[j];
      used += !(P::largest(P::size(whole)) == 0);
    }
    P::store(sizes, P::plus(sum, P::where_larger(off, 0, P::plus(Pack{}, infinite), 0)));
    P::store(load, loads);
    Pack left{};  // a sum, which nothing that is no number is lost in
    const auto look = [&](Index i, auto together) __attribute__((always_inline)) {
      constexpr int entries = decltype(together)::value;
      Pack missing[entries];
      P::clear(missing);
      for (Index j = 0; j < used; ++j) {
        const double* const u = U + terms[j] * n + i;
        const Pack whole = P::load(c + 8 * j);
#pragma GCC unroll 8
        for (int r = 0; r < entries; ++r) P::add_product(missing[r], whole, u[r]);
      }
#pragma GCC unroll 8
      for (int r = 0; r < entries; ++r)
        left = P::plus(left, P::size(P::minus(missing[r], P::load(X + 8 * (i + r)))));
    };
    Index i = 0;
    for (; i + 8 <= n && W == 8; i += 8) look(i, std::integral_constant<int, 8>());
    for (; i + 4 <= n; i += 4) look(i, std::integral_constant<int, 4>());
    for (; i < n; ++i) look(i, std::integral_constant<int, 1>());
    P::store(rest, left);
  }

  MOREAU_INLINE bool cancels(Index n, const double* U, Index p, double whole, Index count, const Index* row,
                             const double* c) {
    if (n == 0) return true;
    double first = -whole * U[p * n];
    for (Index k = 0; k < count; ++k) first += c[k] * U[row[k] * n];
    if (first != 0) return false;  // most that are no sums show it here
    // Packs reach into the row before, where the last would reach beyond its own.
    Pack most{};
    for (Index end = n < 8 ? n : 8; end <= n; end = end == n ? n + 1 : end + 8 < n ? end + 8 : n) {
      const Index i = end - 8;
      Pack sum{};
      const auto take = [&](Index a, double factor) __attribute__((always_inline)) {
        P::add_product(sum, n < 8 ? P::load_before(U + a * n, U + a * n + n) : P::load(U + a * n + i),
                       factor);
      };
      take(p, -whole);
      for (Index k = 0; k < count; ++k) take(row[k], c[k]);
      most = P::larger(most, P::size(sum));
    }
    return P::largest(most) == 0;
  }

  /// The largest of f(x_i) >= 0 over as many whole packs as there are; several at a time, which do not wait
  /// for each other.
  template <class F>
  MOREAU_INLINE Pack largest_over_packs(Index n, const double* x, F f) {
    Pack most[4];
    P::clear(most);
    Index i = 0;
    for (; i + 32 <= n; i += 32)
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) most[k] = P::larger(most[k], f(P::load(x + i + 8 * k)));
    for (; i + 8 <= n; i += 8) most[0] = P::larger(most[0], f(P::load(x + i)));
    return P::larger(P::larger(most[0], most[1]), P::larger(most[2], most[3]));
  }

  MOREAU_INLINE double largest_size(Index n, const double* x) {
    double found = P::largest(largest_over_packs(
        n, x, [](const Pack& now) __attribute__((always_inline)) { return P::size(now); }));
    for (Index i = n / 8 * 8; i < n; ++i) found = found > std::abs(x[i]) ? found : std::abs(x[i]);
    return found;
  }

  MOREAU_INLINE bool is_on_grid(Index n, const double* x, double shift) {
    bool all = P::largest(largest_over_packs(
                   n, x, [&](const Pack& now) __attribute__((always_inline)) {
                     return P::size(P::minus(P::plus(P::plus(now, shift), -shift), now));
                   })) == 0;
    for (Index i = n / 8 * 8; i < n && all; ++i) all = (x[i] + shift) - shift == x[i];
    return all;
  }

  /// Zero times a number that is not finite is not zero.
  MOREAU_INLINE bool is_finite(Index n, const double* x) {
    Pack sum[4];
    P::clear(sum);
    Index i = 0;
    for (; i + 32 <= n; i += 32)
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) P::add_product(sum[k], P::load(x + i + 8 * k), 0);
    for (; i < n; i += 8) P::add_product(sum[0], P::load_before(x + i, x + n), 0);
    return P::total(P::plus(P::plus(sum[0], sum[1]), P::plus(sum[2], sum[3]))) == 0;
  }

  /// By tiles, for the rows of a large matrix are far apart in memory. The difference of numbers that are not
  /// finite is none.
  MOREAU_INLINE bool take_symmetric(Index n, Index ld, const double* A, double* T) {
    for (Index c = 0; c < n; ++c, A += n)
      for (Index i = 0; i < ld; i += 8) P::store(T + c * ld + i, P::load_before(A + i, A + n));
    for (Index c = n; c < ld; ++c) {
      for (Index i = 0; i < ld; i += 8) P::store(T + c * ld + i, Pack{});
      T[c * (ld + 1)] = 1;
    }
    Pack wrong{};
    for (Index j = 0; j < n; j += 8)
      for (Index i = 0; i <= j; i += 8) {
        Pack across[8];
#pragma GCC unroll 8
        for (int c = 0; c < 8; ++c) across[c] = P::load(T + (i + c) * ld + j);
        P::transpose(across);
#pragma GCC unroll 8
        for (int c = 0; c < 8; ++c)
          wrong = P::plus(wrong, P::size(P::minus(P::load(T + (j + c) * ld + i), across[c])));
      }
    return P::total(wrong) == 0;
  }
};

}  // namespace convex::inline dense
