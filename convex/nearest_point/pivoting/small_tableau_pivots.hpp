#pragma once

#include <cmath>
#include <utility>

#include "convex/nearest_point/pivoting/gram_pivoting.hpp"
#include "convex/nearest_point/pivoting/small_tableau_rows.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {

/// A row entering of which less than this part, squared, lies outside the span of those held is nearly
/// dependent, and left to `GramSolve`.
inline constexpr double nearly_dependent = 1e-6;

/// Roundings, times the growth of the sweeps, that stand for 0 in what a row has outside that span.
inline constexpr double sweep_roundings = 64;

/// Sweeps of a `SmallTableau`, and the dual method by them. Packs of places as in `SmallTableauRows`.
template <int W, bool Fused, int packs>
struct SmallTableauPivots : SmallTableauRows<W, Fused, packs> {
  using Rows = SmallTableauRows<W, Fused, packs>;
  using P = Packs<W, Fused>;
  using Pack = typename P::Pack;
  using K = Kernels<W, Fused>;
  using Rows::load_block, Rows::gram_column, Rows::measure_block, Rows::put, Rows::set_outside,
      Rows::set_state, Rows::stride, Rows::take_block, Rows::whiten_blocks;
  static constexpr double infinite = __builtin_inf();

  /// Whether row k, outside, lies in the span of those held, as far as doubles tell; or nearly so.
  MOREAU_INLINE bool is_dependent(const SmallTableau& t, Index k) {
    const double rounding = sweep_roundings * unit_roundoff * t.sweep_growth;
    return !(t.swept_diagonal[k] >
             (GramPivoting::dependence > rounding ? GramPivoting::dependence : rounding) * t.square[k]);
  }
  MOREAU_INLINE bool is_nearly_dependent(const SmallTableau& t, Index k) {
    return !(t.swept_diagonal[k] > nearly_dependent * t.square[k]);
  }

  MOREAU_INLINE void forget_pivots(SmallTableau& t) {
    t.pivots = 0;
    t.sweep_growth = 1;
    for (Index r = 0; r < stride(t); r += 8) P::store(t.swept_diagonal + r, P::load(t.square + r));
    for (Index a = 0; a < stride(t); ++a) t.last_pivot[a] = -1;
  }

  /// What pivot p makes of a column, or of the load.
  MOREAU_INLINE void apply(const SmallTableau& t, Index p, double* x) {
    const double* const column = t.pivot_columns + p * SmallTableau::most;
    const Index k = t.pivot_place[p];
    const double part = x[k] * t.over_pivot[p];
    for (Index r = 0; r < stride(t); r += 8) {
      Pack y = P::load(x + r);
      P::subtract_product(y, P::load(column + r), part);
      P::store(x + r, y);
    }
    put(x, k, t.pivot_sign[p] * part);
  }
  /// What the pivots from p on make of it, two at a time: each loads and stores all entries.
  MOREAU_INLINE void apply_from(const SmallTableau& t, Index p, double* x) {
    for (; p + 2 <= t.pivots; p += 2) {
      const double *const first = t.pivot_columns + p * SmallTableau::most, *const second =
                                                                                first + SmallTableau::most;
      const Index j = t.pivot_place[p], k = t.pivot_place[p + 1];
      const double part = x[j] * t.over_pivot[p], own = t.pivot_sign[p] * part;
      const double other = (j == k ? own : x[k] - first[k] * part) * t.over_pivot[p + 1];
      for (Index r = 0; r < stride(t); r += 8) {
        Pack y = P::load(x + r);
        P::subtract_product(y, P::load(first + r), part);
        P::subtract_product(y, P::load(second + r), other);
        P::store(x + r, y);
      }
      put(x, j, own - second[j] * other);
      put(x, k, t.pivot_sign[p + 1] * other);
    }
    if (p < t.pivots) apply(t, p, x);
  }
  MOREAU_INLINE void find_column(const SmallTableau& t, Index a, double* x) {
    Index p = t.last_pivot[a];
    if (p < 0) {
      gram_column(t, a, x);
    } else {
      const double* const from = t.pivot_columns + p * SmallTableau::most;
      const double factor = t.over_pivot[p] * t.pivot_sign[p];
      for (Index r = 0; r < stride(t); r += 8) P::store(x + r, P::times(P::load(from + r), factor));
      put(x, a, -t.over_pivot[p]);
    }
    apply_from(t, p + 1, x);
  }

  /// Takes row k in or out; raised: what its multiplier has come to before.
  MOREAU_INLINE void sweep(SmallTableau& t, Index k, double raised = 0) {
    Compiled<W, &SmallTableauPivots::sweep_row>::apart(t, k, raised);
  }
  MOREAU_INLINE void sweep_row(SmallTableau& t, Index k, double raised) {
    alignas(64) double column[SmallTableau::most];
    if (t.pivots == SmallTableau::most) sweep_anew(t);
    find_column(t, k, column);
    sweep_column(t, k, column, raised);
    set_state(t, k, !t.held[k]);
  }
  MOREAU_INLINE void sweep_column(SmallTableau& t, Index k, const double* column, double raised) {
    const Index p = t.pivots++;
    const double pivot = column[k], inverse = 1 / pivot, sign = t.held[k] ? -1 : 1;
    const double growth = t.held[k] ? -pivot * t.square[k] : t.square[k] * inverse, load = t.b[k] * inverse;
    t.sweep_growth = growth > t.sweep_growth ? growth : t.sweep_growth;
    t.pivot_place[p] = k;
    t.over_pivot[p] = inverse;
    t.pivot_sign[p] = sign;
    t.last_pivot[k] = p;
    double* const kept = t.pivot_columns + p * SmallTableau::most;
    for (Index r = 0; r < stride(t); r += 8) {
      const Pack c = P::load(column + r);
      Pack b = P::load(t.b + r), diagonal = P::load(t.swept_diagonal + r);
      P::store(kept + r, c);
      P::subtract_product(b, c, load);
      P::store(t.b + r, b);
      P::store(t.swept_diagonal + r, P::minus(diagonal, P::times(c, P::times(c, inverse))));
    }
    put(t.b, k, sign * load + raised);
    put(t.swept_diagonal, k, -inverse);
    t.is_listed = false;
  }

  /// Forgets what pivots there were, but for those that take in the working set.
  MOREAU_INLINE void sweep_anew(SmallTableau& t) {
    Compiled<W, &SmallTableauPivots::sweep_working_set>::apart(t);
  }
  MOREAU_INLINE void sweep_working_set(SmallTableau& t) {
    alignas(64) double b[SmallTableau::most], column[SmallTableau::most];
    copy_packs(stride(t), t.b, b);
    forget_pivots(t);
    for (Index a = 0; a < t.m; ++a)
      if (t.held[a]) {
        t.held[a] = false;
        find_column(t, a, column);
        sweep_column(t, a, column, 0);
        t.held[a] = true;
      }
    copy_packs(stride(t), b, t.b);
  }

  /// Lists the working set.
  MOREAU_INLINE void list_working_set(SmallTableau& t) {
    if (t.is_listed) return;
    t.is_listed = true;
    t.size = 0;
    double squares = 0;
    t.gram_condition = 0;
    for (Index a = 0; a < t.m; ++a) {
      if (!t.held[a]) continue;
      t.length[t.size] = std::sqrt(t.square[a]);
      t.pull[t.size] = t.two_sided[a] ? 0 : t.length[t.size];
      t.rows[t.size] = t.row[a];
      t.place[t.size++] = a;
      squares -= t.swept_diagonal[a];
      t.gram_condition -= t.swept_diagonal[a] * t.square[a];
    }
    t.inverse_norm = std::sqrt(squares);
  }

  /// b := the load as the sweeps change it. Rows that came and went would leave the rounding of their loads.
  MOREAU_INLINE void sweep_load(SmallTableau& t, const double* load) {
    for (Index r = 0; r < stride(t); r += 8) P::store(t.b + r, load_of_held(t, load, r));
    apply_from(t, 0, t.b);
    for (Index r = 0; r < stride(t); r += 8) {
      const Pack outside = P::minus(P::load(load + r), load_of_held(t, load, r));
      P::store(t.b + r, P::plus(P::load(t.b + r), outside));
    }
  }
  MOREAU_INLINE Pack load_of_held(const SmallTableau& t, const double* load, Index r) {
    return P::where_larger(P::load(t.share + r), 0, P::load(load + r), 0);
  }

  /// The block of eight more rows, at the places from `stride` on: what pivots before would have left of
  /// them.
  MOREAU_INLINE void append(SmallTableau& t) {
    const Index before = t.stride;
    t.stride = before + 8;
    take_block(t, before);
    whiten_blocks(t, before);
    measure_block(t, before);
    load_block(t, before);
    set_outside(t, before);
    for (Index a = before; a < t.stride; ++a) {
      t.two_sided[a] = false;
      t.last_pivot[a] = -1;
      t.lambda_at[a] = t.lambda_low_at[a] = 0;
    }
    Pack diagonal = P::load(t.square + before);
    alignas(64) double x[SmallTableau::most];
    Index last[SmallTableau::most];  // of a place, before pivot p
    for (Index p = 0; p < t.pivots; ++p) last[t.pivot_place[p]] = -1;
    for (Index p = 0; p < t.pivots; ++p) {
      const Index k = t.pivot_place[p];
      Index q = std::exchange(last[k], p);
      if (q < 0) Rows::template products<1>(t, k, before, x);
      Pack c = q < 0 ? P::load(x + before)
                     : P::times(P::load(t.pivot_columns + q * SmallTableau::most + before),
                                t.over_pivot[q] * t.pivot_sign[q]);
      Pack odd{};
      const auto take = [&](Pack & sum, Index from) __attribute__((always_inline)) {
        const double* const column = t.pivot_columns + from * SmallTableau::most;
        P::subtract_product(sum, P::load(column + before), column[k] * t.over_pivot[from]);
      };
      for (++q; q + 2 <= p; q += 2) take(c, q), take(odd, q + 1);
      if (q < p) take(c, q);
      c = P::plus(c, odd);
      P::store(t.pivot_columns + p * SmallTableau::most + before, c);
      diagonal = P::minus(diagonal, P::times(c, P::times(c, t.over_pivot[p])));
    }
    P::store(t.swept_diagonal + before, diagonal);
    sweep_load(t, t.load);
  }

  /// D = A⁻¹U_Sᵀ (U_S A⁻¹U_Sᵀ)⁻¹, by eight columns side by side.
  MOREAU_INLINE void dual_rows(const SmallTableau& t, double* dual) {
    const Index width = padded(t.size);
    alignas(64) double block[8 * SmallTableau::most_coordinates], inverse[8 * SmallTableau::most],
        column[SmallTableau::most];
    fill_packs(t.n * width, 0, dual);
    for (Index first = 0; first < t.size; first += 8) {
      const Index count = t.size - first < 8 ? t.size - first : 8;
      fill_packs(8 * t.n, 0, block);
      fill_packs(8 * width, 0, inverse);
      for (Index l = 0; l < count; ++l) {
        const Index p = t.place[first + l];
        const double* const from = t.whitened + p / 8 * 8 * t.n + p % 8;
        find_column(t, p, column);
        for (Index i = 0; i < t.n; ++i) block[8 * i + l] = from[8 * i];
        for (Index k = 0; k < t.size; ++k) inverse[width * l + k] = -column[t.place[k]];
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

  /// The place of the largest of `count` entries of x, the first if there are several.
  MOREAU_INLINE Index largest(const double (&x)[SmallTableau::most], Index count) {
    Pack best = P::load(x);
    for (Index r = 8; r < count; r += 8) best = P::larger(best, P::load(x + r));
    const double most = P::largest(best);
    Index at = 0;
    while (at < count - 1 && !(x[at] >= most)) ++at;
    return at;
  }

  /// The dual method of Goldfarb and Idnani (1983) on the swept tableau: rows whose multiplier b is negative
  /// go, the most negative first; then the row violated most has its multiplier raised until it holds. Its
  /// column tells by how much all others change with it; those held whose multiplier comes down to 0 on the
  /// way go. norm: ||·|| of the whitened linear term that the load is of.
  MOREAU_INLINE bool pivot(SmallTableau& t, const double* load, double norm) {
    return Compiled<W, &SmallTableauPivots::pivot_rows>::apart(t, load, norm);
  }
  MOREAU_INLINE bool pivot_rows(SmallTableau& t, const double* load, double norm) {
    const Index patience = t.steps + 4 * t.m + 8;
    alignas(64) double wrong[SmallTableau::most];
    for (;; ++t.steps) {
      for (Index r = 0; r < stride(t); r += 8)
        P::store(wrong + r, P::times(P::load(t.b + r), P::load(t.leave + r)));
      const Index a = largest(wrong, stride(t));
      if (!(wrong[a] > 0)) break;
      if (t.steps == patience) return false;
      sweep(t, a);
    }
    for (;; ++t.steps) {
      Pack energy{};
      for (Index r = 0; r < stride(t); r += 8) {
        const Pack b = P::load(t.b + r);
        P::store(wrong + r, P::times(b, P::load(t.enter + r)));
        P::add_products(energy, P::times(b, P::load(t.share + r)), P::load(load + r));
      }
      const Index a = largest(wrong, stride(t));
      // A violation counts beyond this part of norm and the root of |energy|, for which it need not wait.
      const double beyond = wrong[a] / GramPivoting::least_violation - norm;
      if (!(beyond > 0 && beyond * beyond > std::abs(P::total(energy)))) return true;
      if (!raise(t, a, patience)) return false;
    }
  }

  /// Takes in row a, which is violated.
  MOREAU_INLINE bool raise(SmallTableau& t, Index a, Index patience) {
    alignas(64) double column[SmallTableau::most], falls[SmallTableau::most];
    find_column(t, a, column);
    for (double raised = 0; t.steps < patience; ++t.steps) {
      if (t.pivots == SmallTableau::most) sweep_anew(t);
      const bool dependent = is_dependent(t, a);
      if (!dependent && is_nearly_dependent(t, a)) return false;
      // What falls fast enough beside the length of row a that it is no rounding comes to 0 after b / column.
      const double least = zero_coefficient * t.scale_at[a];
      for (Index r = 0; r < stride(t); r += 8) {
        const Pack c = P::load(column + r);
        P::store(falls + r, P::where_larger(P::times(c, P::times(P::load(t.leave + r), -1)), least,
                                            P::times(P::over(P::load(t.b + r), c), -1), -infinite));
      }
      const Index first = largest(falls, stride(t));
      const double partial = falls[first] < 0 ? -falls[first] : 0;
      if (!dependent && t.b[a] <= partial * column[a]) {
        sweep_column(t, a, column, raised);
        set_state(t, a, true);
        return true;
      }
      if (!(partial < infinite)) {
        t.dependent = a;
        return false;
      }
      raised += partial;
      for (Index r = 0; r < stride(t); r += 8) {
        Pack b = P::load(t.b + r);
        P::subtract_product(b, P::load(column + r), partial);
        P::store(t.b + r, P::with_entry(b, first - r, 0));
      }
      sweep(t, first);
      apply(t, t.pivots - 1, column);
    }
    return false;
  }
};

}  // namespace convex::inline pivoting
