#pragma once

#include <cmath>

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
  using Rows::set_state, Rows::stride;
  static constexpr double infinite = __builtin_inf();

  /// Whether row k, outside, lies in the span of those held, as far as doubles tell; or nearly so.
  MOREAU_INLINE bool is_dependent(const SmallTableau& t, Index k) {
    const double rounding = sweep_roundings * unit_roundoff * t.sweep_growth;
    return !(t.swept[k * (stride(t) + 1)] >
             (GramPivoting::dependence > rounding ? GramPivoting::dependence : rounding) * t.square[k]);
  }
  MOREAU_INLINE bool is_nearly_dependent(const SmallTableau& t, Index k) {
    return !(t.swept[k * (stride(t) + 1)] > nearly_dependent * t.square[k]);
  }

  /// Takes row k in or out; raised: what its multiplier has come to before.
  MOREAU_INLINE void sweep(SmallTableau& t, Index k, double raised = 0) {
    if constexpr (packs == 1)
      Compiled<W, &SmallTableauPivots::template sweep_packs<1>>::apart(t, k, raised);
    else if (t.stride <= SmallTableau::few_rows)
      Compiled<W, &SmallTableauPivots::template sweep_packs<SmallTableau::few_rows / 8>>::apart(t, k, raised);
    else
      Compiled<W, &SmallTableauPivots::template sweep_packs<SmallTableau::most / 8>>::apart(t, k, raised);
  }
  /// A column has `most` packs at most.
  template <int most>
  MOREAU_INLINE void sweep_packs(SmallTableau& t, Index k, double raised) {
    const Index step = stride(t);
    double* const column = t.swept + k * step;
    const double pivot = column[k], inverse = 1 / pivot, sign = t.held[k] ? -1 : 1;
    const double growth = t.held[k] ? -pivot * t.square[k] : t.square[k] * inverse;
    t.sweep_growth = growth > t.sweep_growth ? growth : t.sweep_growth;
    alignas(64) double part[SmallTableau::most];
    Pack c[most], scaled[most];
    const double load = t.b[k] * inverse;
#pragma GCC unroll 8
    for (int r = 0; r < most; ++r) {
      if (8 * r == step) break;
      c[r] = P::load(column + 8 * r);
      scaled[r] = P::times(c[r], inverse);
      P::store(part + 8 * r, scaled[r]);
      Pack b = P::load(t.b + 8 * r);
      P::subtract_product(b, c[r], load);
      P::store(t.b + 8 * r, P::with_entry(b, k - 8 * r, sign * load + raised));
    }
    for (Index j = 0; j < t.m; ++j) {
      double* const other = t.swept + j * step;
#pragma GCC unroll 8
      for (int r = 0; r < most; ++r) {
        if (8 * r == step) break;
        Pack x = P::load(other + 8 * r);
        P::subtract_product(x, c[r], part[j]);
        P::store(other + 8 * r, x);
      }
      other[k] = sign * part[j];
    }
#pragma GCC unroll 8
    for (int r = 0; r < most; ++r) {
      if (8 * r == step) break;
      P::store(column + 8 * r, P::times(scaled[r], sign));
    }
    column[k] = -inverse;
    t.is_listed = false;
    set_state(t, k, !t.held[k]);
  }

  /// Lists the rows held.
  MOREAU_INLINE void list_rows_held(SmallTableau& t) {
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
      squares -= t.swept[a * (stride(t) + 1)];
      t.gram_condition -= t.swept[a * (stride(t) + 1)] * t.square[a];
    }
    t.inverse_norm = std::sqrt(squares);
  }

  /// b := the load as the sweeps have changed it.
  MOREAU_INLINE void sweep_load(SmallTableau& t, const double* load) {
    list_rows_held(t);
    for (Index r = 0; r < stride(t); r += 8) {
      Pack b = P::load(load + r);
      b = P::minus(b, P::times(b, P::load(t.share + r)));
      for (Index k = 0; k < t.size; ++k)
        P::subtract_product(b, P::load(t.swept + t.place[k] * stride(t) + r), load[t.place[k]]);
      P::store(t.b + r, b);
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
    const double* const column = t.swept + a * stride(t);
    alignas(64) double falls[SmallTableau::most];
    for (double raised = 0; t.steps < patience; ++t.steps) {
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
        sweep(t, a, raised);
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
    }
    return false;
  }
};

}  // namespace convex::inline pivoting
