#pragma once

#include <cmath>

#include "convex/dense/pack_kernels.hpp"
#include "convex/nearest_point/pivoting/small_tableau.hpp"

namespace convex::inline pivoting {

/// The rows that a `SmallTableau` looks at: whitened, with their Gram matrix, swept as that of those before.
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

  /// The products of the block at r with itself and those before.
  MOREAU_INLINE void multiply_block(SmallTableau& t, Index r) {
    for (Index other = 0; other <= r; other += 8)
      K::gram(t.n, t.whitened + other * t.n, t.whitened + r * t.n, t.swept + r * stride(t) + other,
              stride(t));
    for (Index a = r; a < r + 8; ++a) t.square[a] = t.swept[a * (stride(t) + 1)];
  }

  /// Rows r to r + 7 of the columns before are those of the columns r to r + 7.
  MOREAU_INLINE void mirror_block(SmallTableau& t, Index r) {
    for (Index other = 0; other < r; other += 8) {
      Pack block[8];
#pragma GCC unroll 8
      for (int l = 0; l < 8; ++l) block[l] = P::load(t.swept + (r + l) * stride(t) + other);
      P::transpose(block);
#pragma GCC unroll 8
      for (int l = 0; l < 8; ++l) P::store(t.swept + (other + l) * stride(t) + r, block[l]);
    }
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

  MOREAU_INLINE void append(SmallTableau& t) {
    const Index before = t.stride, step = before + 8;
    for (Index j = before - 1; j > 0; --j)
      for (Index r = before - 8; r >= 0; r -= 8)
        P::store(t.swept + j * step + r, P::load(t.swept + j * before + r));
    t.stride = step;
    take_block(t, before);
    whiten_blocks(t, before);
    multiply_block(t, before);
    load_block(t, before);
    alignas(64) double products[8 * SmallTableau::most];  // with the rows held
    Index held[SmallTableau::most], count = 0;
    for (Index k = 0; k < before; ++k)
      if (t.held[k]) {
        held[count] = k;
        for (Index l = 0; l < 8; ++l) {
          double& product = t.swept[(before + l) * step + k];
          products[8 * count + l] = product;
          product = 0;
        }
        ++count;
      }
    double* const fresh = t.swept + before * step;
    for (Index r = 0; r <= before; r += 8) {
      const bool is_own = r == before;
      const Index stride = is_own ? step : 1;
      Pack x[8];
#pragma GCC unroll 8
      for (int l = 0; l < 8; ++l) x[l] = P::load(fresh + l * step + r);
      for (Index k = 0; k < count; ++k) {
        const Pack column = P::load(is_own ? products + 8 * k : t.swept + held[k] * step + r);
        const double* const factor = is_own ? fresh + held[k] : products + 8 * k;
#pragma GCC unroll 8
        for (int l = 0; l < 8; ++l) P::subtract_product(x[l], column, factor[l * stride]);
      }
#pragma GCC unroll 8
      for (int l = 0; l < 8; ++l) P::store(fresh + l * step + r, x[l]);
    }
    for (Index l = 0; l < 8; ++l) {
      double& b = t.b[before + l] = t.load[before + l];
      for (Index k = 0; k < count; ++k) b -= t.load[held[k]] * fresh[l * step + held[k]];
      t.two_sided[before + l] = false;
      t.lambda_at[before + l] = t.lambda_low_at[before + l] = 0;
    }
    set_outside(t, before);
    mirror_block(t, before);
  }

  /// D = A⁻¹U_Sᵀ (U_S A⁻¹U_Sᵀ)⁻¹, by eight columns side by side.
  MOREAU_INLINE void dual_rows(const SmallTableau& t, double* dual) {
    const Index width = padded(t.size);
    alignas(64) double block[8 * SmallTableau::most_coordinates], inverse[8 * SmallTableau::most];
    fill_packs(t.n * width, 0, dual);
    for (Index first = 0; first < t.size; first += 8) {
      const Index count = t.size - first < 8 ? t.size - first : 8;
      fill_packs(8 * t.n, 0, block);
      fill_packs(8 * width, 0, inverse);
      for (Index l = 0; l < count; ++l) {
        const Index p = t.place[first + l];
        const double *const from = t.whitened + p / 8 * 8 * t.n + p % 8, *const swept =
                                                                             t.swept + p * t.stride;
        for (Index i = 0; i < t.n; ++i) block[8 * i + l] = from[8 * i];
        for (Index k = 0; k < t.size; ++k) inverse[width * l + k] = -swept[t.place[k]];
      }
      K::backward_pack(t.n, t.ld, t.T, t.inverse, block);
      for (Index i = 0; i < t.n; ++i)
        for (Index k = 0; k < width; k += 8) {
          Pack sum = P::load(dual + k * t.n + 8 * i);
          for (Index l = 0; l < count; ++l)
            P::add_product(sum, P::load(inverse + width * l + k), block[8 * i + l]);
          P::store(dual + k * t.n + 8 * i, sum);
        }
    }
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

  /// Of the rows a = k mod 8, of which packs come one after the other, that with the smallest depth.
  struct Deepest {
    Pack least{}, at{}, now;
    MOREAU_INLINE_MEMBER void take(const Pack& depth) {
      P::keep_smaller(least, at, depth, now);
      now = P::plus(now, 8);
    }
    MOREAU_INLINE_MEMBER void store(double* depth, double* row) const {
      P::store(depth, least);
      P::store(row, at);
    }
  };
  MOREAU_INLINE Deepest none_yet() {
    alignas(64) constexpr double first[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    return {{}, {}, P::load(first)};
  }

  MOREAU_INLINE void deepest(Index m, Index n, const double* U, const double* q, const double* s,
                             const double* inverse_length, double* slack, double* depth, double* row) {
    Deepest found = none_yet();
    by_eights(
        m, n, U, typename K::Product{q}, [&](Index a, const Pack& sum) __attribute__((always_inline)) {
          const Pack x = P::minus(sum, P::load_before(s + a, s + m));
          P::store(slack + a, x);
          found.take(P::times(x, P::load(inverse_length + a)));
        });
    found.store(depth, row);
  }

  MOREAU_INLINE void deepest_known(Index m, const double* slack, const double* inverse_length, double* depth,
                                   double* row) {
    Deepest found = none_yet();
    for (Index a = 0; a < m; a += 8) found.take(P::times(P::load(slack + a), P::load(inverse_length + a)));
    found.store(depth, row);
  }
};

}  // namespace convex::inline pivoting
