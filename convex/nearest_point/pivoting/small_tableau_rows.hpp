#pragma once

#include <cmath>

#include "convex/dense/pack_kernels.hpp"
#include "convex/nearest_point/pivoting/small_tableau.hpp"

namespace convex::inline pivoting {

/// The rows that a `SmallTableau` looks at, whitened.
/// Packs of places: 1 when n and they are at most 8, so that loops over packs vanish; else 4, which stands
/// for any number.
template <int W, bool Fused, int packs>
struct SmallTableauRows : Kernels<W, Fused> {
  using K = Kernels<W, Fused>;
  using P = Packs<W, Fused>;
  using Pack = typename P::Pack;

  MOREAU_INLINE Index ld(const SmallTableau& t) { return packs == 1 ? 8 : t.ld; }
  MOREAU_INLINE Index stride(const SmallTableau& t) { return packs == 1 ? 8 : t.stride; }

  /// X := f(X) for each pack of `count` doubles.
  template <class Work>
  MOREAU_INLINE void each(Index count, Work work) {
    for (Index i = 0; i < count; i += 8) work(i);
  }

  /// x_a := value. By the pack: a number by itself would keep the next that loads it waiting until it has
  /// reached the memory.
  MOREAU_INLINE void put(double* x, Index a, double value) {
    double* const pack = x + a / 8 * 8;
    P::store(pack, P::with_entry(P::load(pack), a % 8, value));
  }

  MOREAU_INLINE void set_state(SmallTableau& t, Index a, bool held) {
    t.held[a] = held;
    put(t.share, a, held ? 1 : 0);
    const bool may_leave = held && !t.two_sided[a];
    put(t.leave, a, may_leave ? -t.scale_at[a] : 0);
    put(t.enter, a, held ? 0 : t.inverse_scale[a]);
  }

  /// The block at r, of which no row is held.
  MOREAU_INLINE void set_outside(SmallTableau& t, Index r) {
    for (Index a = r; a < r + 8; ++a) t.held[a] = false;
    P::store(t.share + r, Pack{});
    P::store(t.leave + r, Pack{});
    P::store(t.enter + r, P::load(t.inverse_scale + r));
  }

  MOREAU_INLINE void take_diagonal(SmallTableau& t, const double* diagonal) {
    for (Index i = 0; i < ld(t); i += 8) {
      const Pack x = P::load_before(diagonal + i, diagonal + t.n),
                 inverse = P::where_larger(x, 0, P::over(P::plus(Pack{}, 1), x), 0);
      P::store(t.diagonal + i, x);
      P::store(t.inverse_diagonal + i, inverse);
      P::store(t.unit + i, P::root(inverse));
    }
  }

  MOREAU_INLINE void whiten_z(SmallTableau& t) {
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) {
          const Pack x = P::load_before(t.linear + i, t.linear + t.n);
          P::store(t.z + i, x);
          P::store(t.w_free + i, x);
        });
    K::forward(t.n, ld(t), t.T, t.inverse, t.w_free);
    t.z_norm = std::sqrt(K::dot(ld(t), t.w_free, t.w_free));
  }

  /// Takes in the rows of the block at r, as they are.
  MOREAU_INLINE void take_block(SmallTableau& t, Index r) {
    const Index n = t.n;
    double *const raw = t.raw + r * n, *const whitened = t.whitened + r * n;
    K::side_by_side(n, t.all, t.U, t.row + r, t.m - r < 8 ? t.m - r : 8, raw);
    Pack square[2];
    P::clear(square);
    const double* const weight = t.inverse_diagonal;
    const auto add = [&](int odd, Index i) __attribute__((always_inline)) {
      const Pack u = P::load(raw + 8 * i);
      P::store(whitened + 8 * i, u);
      P::add_products(square[odd], P::times(u, weight[i]), u);
    };
    Index i = 0;
    for (; i + 2 <= n; i += 2) add(0, i), add(1, i + 1);
    if (i < n) add(0, i);
    const Pack scale = P::root(P::plus(square[0], square[1]));
    P::store(t.scale_at + r, scale);
    P::store(t.inverse_scale + r, P::where_larger(scale, 0, P::over(P::plus(Pack{}, 1), scale), 0));
  }

  /// Whitens the blocks from r on.
  MOREAU_INLINE void whiten_blocks(SmallTableau& t, Index r) {
    constexpr int together = W == 8 && packs > 1 ? 2 : 1;
    for (; r + 8 * together <= stride(t); r += 8 * together)
      K::template forward_packs<together>(t.n, ld(t), t.T, t.inverse, t.whitened + r * t.n, 8 * t.n);
    if constexpr (together > 1)
      if (r < stride(t)) K::forward_pack(t.n, ld(t), t.T, t.inverse, t.whitened + r * t.n);
  }

  MOREAU_INLINE void measure_block(SmallTableau& t, Index r) {
    Pack square[4];
    P::clear(square);
    const double* const v = t.whitened + r * t.n;
    const auto add = [&](int k, Index i) __attribute__((always_inline)) {
      const Pack x = P::load(v + 8 * i);
      P::add_products(square[k], x, x);
    };
    Index i = 0;
    for (; i + 4 <= t.n; i += 4)
#pragma GCC unroll 4
      for (int k = 0; k < 4; ++k) add(k, i + k);
    for (; i < t.n; ++i) add(0, i);
    P::store(t.square + r, P::plus(P::plus(square[0], square[2]), P::plus(square[1], square[3])));
  }

  /// The products of row a with those of `count` blocks from r on.
  template <int count>
  MOREAU_INLINE void products(const SmallTableau& t, Index a, Index r, double* into) {
    Pack sum[2][count];
    P::clear(sum[0]), P::clear(sum[1]);
    const double *const V = t.whitened + r * t.n, *const v = t.whitened + a / 8 * 8 * t.n + a % 8;
    const auto add = [&](int odd, Index i) __attribute__((always_inline)) {
#pragma GCC unroll 4
      for (int k = 0; k < count; ++k) P::add_product(sum[odd][k], P::load(V + 8 * (k * t.n + i)), v[8 * i]);
    };
    Index i = 0;
    for (; i + 2 <= t.n; i += 2) add(0, i), add(1, i + 1);
    if (i < t.n) add(0, i);
#pragma GCC unroll 4
    for (int k = 0; k < count; ++k) P::store(into + r + 8 * k, P::plus(sum[0][k], sum[1][k]));
  }
  /// The products of row a with all: its column of the Gram matrix.
  MOREAU_INLINE void gram_column(const SmallTableau& t, Index a, double* column) {
    constexpr int together = packs == 1 ? 1 : W == 8 ? 4 : 2;
    Index r = 0;
    for (; r + 8 * together <= stride(t); r += 8 * together) products<together>(t, a, r, column);
    for (; r < stride(t); r += 8) products<1>(t, a, r, column);
  }

  /// The levels and loads of the block at r.
  MOREAU_INLINE void load_block(SmallTableau& t, Index r) {
    if (t.all <= SmallTableau::few_rows)
      P::store(t.level + r, P::load_before(t.s + r, t.s + t.all));
    else
      for (Index p = r; p < r + 8; ++p) t.level[p] = t.row[p] < 0 ? 0 : t.s[t.row[p]];
    K::dots(t.n, t.whitened + r * t.n, t.w_free, t.load + r);
    P::store(t.load + r, P::minus(P::load(t.level + r), P::load(t.load + r)));
  }

  MOREAU_INLINE Index close_rows(Index m, const double* slack, const double* s, const double* end,
                                 const double* length, double absolute, double by_length, Index most,
                                 Index* rows) {
    Index count = 0;
    for (Index a = 0; a < m && count <= most; a += 8) {
      const Pack level = P::load_before(s + a, end);
      Pack bound = P::times(P::size(level), absolute);
      P::add_product(bound, P::load(length + a), by_length);
      const Pack above = P::minus(P::load(slack + a), bound);
      if (P::total(P::where_larger(above, 0, Pack{}, 1)) == 0) continue;
      double each[8];
      P::store(each, above);
      for (Index k = 0; k < 8 && a + k < m; ++k) {
        rows[count] = a + k;
        count += !(each[k] > 0);
      }
    }
    return count;
  }

  /// work(a, sums along rows a to a + 7), 0 where there is no row.
  template <class Terms, class Work>
  MOREAU_INLINE void by_eights(Index m, Index n, const double* U, const Terms& terms, Work work) {
    double rest[8] = {};
    K::each_sum(
        m, n, U, terms,
        work, [&rest](Index a, double sum) __attribute__((always_inline)) { rest[a % 8] = sum; });
    if (m % 8 > 0) work(m / 8 * 8, P::load(rest));
  }

  /// The exponent halved, and one step of Newton's method.
  MOREAU_INLINE double rough_lengths(Index m, Index n, const double* U, const double* weight, double longer,
                                     double* length, double* inverse) {
    Pack all{};
    by_eights(
        m, n, U, typename K::Square{weight}, [&](Index a, const Pack& x) __attribute__((always_inline)) {
          const Pack guess = P::halved_exponent(x);
          const Pack cube = P::times(P::times(guess, guess), P::times(guess, P::times(x, 0.5)));
          const Pack root = P::where_larger(x, 0, P::minus(P::times(guess, 1.5), cube), 0);
          const Pack size = P::times(P::times(root, longer), x);
          P::store(inverse + a, root);
          P::store(length + a, size);
          P::add_products(all, size, size);
        });
    return P::total(all);
  }

  MOREAU_INLINE void deepest(Index m, Index n, const double* U, const double* q, const double* s,
                             const double* inverse_length, double* slack, double* depth, double* row) {
    alignas(64) constexpr double first[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    Pack least{}, at{}, now = P::load(first);
    by_eights(
        m, n, U, typename K::Product{q}, [&](Index a, const Pack& sum) __attribute__((always_inline)) {
          const Pack x = P::minus(sum, P::load_before(s + a, s + m));
          P::store(slack + a, x);
          P::keep_smaller(least, at, P::times(x, P::load(inverse_length + a)), now);
          now = P::plus(now, 8);
        });
    P::store(depth, least);
    P::store(row, at);
  }
};

}  // namespace convex::inline pivoting
