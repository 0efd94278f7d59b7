#pragma once

#include <utility>

#include "convex/dense/packs.hpp"

namespace convex::inline dense {

/// The kernels of `DenseKernels` along the rows of U, m×n by rows, and what others make of sums along them.
template <int W, bool Fused>
struct RowKernels {
  using P = Packs<W, Fused>;
  using Pack = typename P::Pack;
  using Part = typename P::Part;
  static constexpr int rows = W == 8 ? 8 : 4;  ///< at a time, as registers allow

  /// u_ai x_i and u_ai² x_i: `along` a row by packs, or one entry of eight rows, or of one.
  struct Product {
    const double* x;
    MOREAU_INLINE_MEMBER Pack along(Index i, const Pack& u) const { return P::times(u, P::load(x + i)); }
    MOREAU_INLINE_MEMBER Pack across(int i, const Pack& u) const { return P::times(u, x[i]); }
    MOREAU_INLINE_MEMBER double single(int i, double u) const { return u * x[i]; }
  };
  struct Square {
    const double* x;
    MOREAU_INLINE_MEMBER Pack along(Index i, const Pack& u) const {
      return P::times(P::times(u, P::load(x + i)), u);
    }
    MOREAU_INLINE_MEMBER Pack across(int i, const Pack& u) const { return P::times(P::times(u, x[i]), u); }
    MOREAU_INLINE_MEMBER double single(int i, double u) const { return u * x[i] * u; }
  };

  /// Sums along `count` rows, from which nothing may be read beyond `end`; x is 0 where rows have ended.
  template <int count, class Terms>
  MOREAU_INLINE void along(Index n, const double* U, const double* end, const Terms& terms,
                           Pack (&sum)[count]) {
    P::clear(sum);
    Index i = 0;
    for (; i + 8 <= n; i += 8)
#pragma GCC unroll 8
      for (int r = 0; r < count; ++r) sum[r] = P::plus(sum[r], terms.along(i, P::load(U + r * n + i)));
    if (i < n)
#pragma GCC unroll 8
      for (int r = 0; r < count; ++r) {
        // A row that others follow has at least as many numbers behind it as its last pack reaches beyond.
        const double* const from = U + r * n + i;
        sum[r] = P::plus(sum[r], terms.along(i, r < count - 1 ? P::load(from) : P::load_before(from, end)));
      }
  }

  /// Entry i of eight rows of n <= 4, n registers of eight.
  template <int n, int i, std::size_t... k>
  MOREAU_INLINE Part column(const Part (&u)[n], std::index_sequence<k...>) {
    constexpr typename P::Wholes inside{(k * n + i) % 16 ...}, join{(k * n + i < 16 ? k : 8 + k)...},
        beside_last{(k * n + i < 16 ? k : k * n + i - 8)...};
    if constexpr (n == 1) return u[0];
    const Part first = __builtin_shuffle(u[0], u[n > 1], inside);
    if constexpr (n <= 2) return first;
    if constexpr (n == 3) return __builtin_shuffle(first, u[n - 1], beside_last);
    return __builtin_shuffle(first, __builtin_shuffle(u[n > 2 ? 2 : 0], u[n - 1], inside), join);
  }
  template <int n, std::size_t... i>
  MOREAU_INLINE void rows_to_columns(Part (&u)[n], std::index_sequence<i...>) {
    if constexpr (W == 8) {
      const Part x[n] = {column<n, i>(u, std::make_index_sequence<8>())...};
      ((u[i] = x[i]), ...);
    } else if constexpr (n == 2) {
      const Part low = __builtin_shuffle(u[0], u[1], typename P::Wholes{0, 1, 4, 5}),
                 high = __builtin_shuffle(u[0], u[1], typename P::Wholes{2, 3, 6, 7});
      u[0] = __builtin_shuffle(low, high, typename P::Wholes{0, 4, 2, 6});
      u[1] = __builtin_shuffle(low, high, typename P::Wholes{1, 5, 3, 7});
    } else if constexpr (n == 3) {
      using Places = typename P::Wholes;
      const Part a = __builtin_shuffle(u[0], u[1], Places{0, 1, 6, 7}),
                 b = __builtin_shuffle(u[0], u[2], Places{2, 3, 4, 5}),
                 c = __builtin_shuffle(u[1], u[2], Places{0, 1, 6, 7});
      u[0] = __builtin_shuffle(a, b, Places{0, 5, 2, 7});
      u[1] = __builtin_shuffle(a, c, Places{1, 4, 3, 6});
      u[2] = __builtin_shuffle(b, c, Places{0, 5, 2, 7});
    } else if constexpr (n == 4) {
      P::transpose_four(u[0], u[1], u[2], u[3]);
    }
  }

  /// x_i: entry i of eight rows of n <= 4.
  template <int n>
  MOREAU_INLINE void columns(const double* U, Pack (&x)[n]) {
    if constexpr (W >= 4) {
#pragma GCC unroll 2
      for (int part = 0; part < P::parts; ++part) {
        Part u[n];
#pragma GCC unroll 4
        for (int k = 0; k < n; ++k) std::memcpy(&u[k], U + W * (part * n + k), sizeof(Part));
        rows_to_columns(u, std::make_index_sequence<n>());
#pragma GCC unroll 4
        for (int i = 0; i < n; ++i) x[i].part[part] = u[i];
      }
    } else {
      double entry[n][8];
      for (int k = 0; k < 8; ++k)
        for (int i = 0; i < n; ++i) entry[i][k] = U[k * n + i];
      for (int i = 0; i < n; ++i) x[i] = P::load(entry[i]);
    }
  }

  /// work(a, sums) for eight rows from a on, as often as there are eight, and rest(a, sum) for each of those
  /// left. few: n, for so few entries that a pack would be mostly empty, else 0.
  template <int few, class Terms, class Work, class Rest>
  MOREAU_INLINE void each_sum(Index m, Index n, const double* U, const Terms& terms, Work work, Rest rest) {
    const double* const end = U + m * n;
    Index a = 0;
    for (; a + 8 <= m; a += 8, U += 8 * n)
      if constexpr (few > 0) {
        Pack x[few];
        columns(U, x);
        Pack sum = terms.across(0, x[0]);
#pragma GCC unroll 4
        for (int i = 1; i < few; ++i) sum = P::plus(sum, terms.across(i, x[i]));
        work(a, sum);
      } else if constexpr (W == 8) {
        Pack sum[8];
        along(n, U, end, terms, sum);
        work(a, P::totals(sum));
      } else {
        double total[8];
        for (int half = 0; half < 8; half += 4) {
          Pack sum[4];
          along(n, U + half * n, end, terms, sum);
#pragma GCC unroll 4
          for (int r = 0; r < 4; ++r) total[half + r] = P::total(sum[r]);
        }
        work(a, P::load(total));
      }
    for (; a < m; ++a, U += n)
      if constexpr (few > 0) {
        double sum = terms.single(0, U[0]);
#pragma GCC unroll 4
        for (int i = 1; i < few; ++i) sum += terms.single(i, U[i]);
        rest(a, sum);
      } else {
        Pack sum[1];
        along(n, U, end, terms, sum);
        rest(a, P::total(sum[0]));
      }
  }
  template <class Terms, class Work, class Rest>
  MOREAU_INLINE void each_sum(Index m, Index n, const double* U, const Terms& terms, Work work, Rest rest) {
    if (n == 1) return each_sum<1>(m, n, U, terms, work, rest);
    if (n == 2) return each_sum<2>(m, n, U, terms, work, rest);
    if (n == 3) return each_sum<3>(m, n, U, terms, work, rest);
    if (n == 4) return each_sum<4>(m, n, U, terms, work, rest);
    each_sum<0>(m, n, U, terms, work, rest);
  }

  template <int n>
  MOREAU_INLINE bool few_begin_without_zero(Index m, const double* U) {
    Pack least = P::plus(Pack{}, 1);
    Index a = 0;
    for (; a + 8 <= m; a += 8, U += 8 * n) {
      Pack x[n];
      columns(U, x);
      least = P::smaller(P::size(x[0]), least);
    }
    for (; a < m; ++a, U += n)
      if (*U == 0) return false;
    return P::total(P::where_larger(least, 0, Pack{}, 1)) == 0;
  }
  MOREAU_INLINE bool first_entries_differ_from_zero(Index m, Index n, const double* U) {
    if (n == 1) return few_begin_without_zero<1>(m, U);
    if (n == 2) return few_begin_without_zero<2>(m, U);
    if (n == 3) return few_begin_without_zero<3>(m, U);
    for (Index a = 0; a < m; ++a, U += n)
      if (*U == 0) return false;
    return true;
  }

  MOREAU_INLINE void slacks(Index m, Index n, const double* U, const double* x, const double* s,
                            double* into) {
    each_sum(
        m, n, U, Product{x},
        [&](Index a, const Pack& sum)
            __attribute__((always_inline)) { P::store(into + a, P::minus(sum, P::load(s + a))); },
        [&](Index a, double sum) __attribute__((always_inline)) { into[a] = sum - s[a]; });
  }

  MOREAU_INLINE void squares(Index m, Index n, const double* U, const double* weight, double* into) {
    each_sum(
        m, n, U, Square{weight},
        [&](Index a, const Pack& sum) __attribute__((always_inline)) { P::store(into + a, sum); },
        [&](Index a, double sum) __attribute__((always_inline)) { into[a] = sum; });
  }
};

}  // namespace convex::inline dense
