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

/// `SmallKernels`, to be compiled for a processor family each. Packs of places at most: 1 when n and they are
/// at most 8, so that loops over packs vanish; 4 or 8 otherwise.
template <int W, bool Fused, int packs>
struct SmallTableauSteps : SmallTableauRows<W, Fused, packs> {
  using Rows = SmallTableauRows<W, Fused, packs>;
  using K = Kernels<W, Fused>;
  using P = Packs<W, Fused>;
  using Pack = typename P::Pack;
  using Rows::each, Rows::ld, Rows::load_block, Rows::mirror_block, Rows::set_state, Rows::stride,
      Rows::whiten_block, Rows::whiten_z;
  static constexpr double infinite = __builtin_inf();

  /// Whether row k, outside, lies in the span of those held, as far as doubles tell; or nearly so.
  MOREAU_INLINE bool is_dependent(const SmallTableau& t, Index k) {
    const double rounding = sweep_roundings * unit_roundoff * t.growth;
    return !(t.swept[k * (stride(t) + 1)] >
             (GramPivoting::dependence > rounding ? GramPivoting::dependence : rounding) * t.square[k]);
  }
  MOREAU_INLINE bool is_nearly_dependent(const SmallTableau& t, Index k) {
    return !(t.swept[k * (stride(t) + 1)] > nearly_dependent * t.square[k]);
  }

  /// Takes row k in or out.
  MOREAU_INLINE void sweep(SmallTableau& t, Index k) {
    const Index step = stride(t);
    double* const column = t.swept + k * step;
    const double pivot = column[k], inverse = 1 / pivot, sign = t.held[k] ? -1 : 1;
    const double growth = t.held[k] ? -pivot * t.square[k] : t.square[k] * inverse;
    t.growth = growth > t.growth ? growth : t.growth;
    alignas(64) double part[SmallTableau::most];
    Pack c[packs], scaled[packs];
    const double load = t.b[k] * inverse;
#pragma GCC unroll 8
    for (int r = 0; r < packs; ++r) {
      if (8 * r == step) break;
      c[r] = P::load(column + 8 * r);
      scaled[r] = P::times(c[r], inverse);
      P::store(part + 8 * r, scaled[r]);
      Pack b = P::load(t.b + 8 * r);
      P::subtract_product(b, c[r], load);
      P::store(t.b + 8 * r, b);
    }
    for (Index j = 0; j < t.m; ++j) {
      double* const other = t.swept + j * step;
#pragma GCC unroll 8
      for (int r = 0; r < packs; ++r) {
        if (8 * r == step) break;
        Pack x = P::load(other + 8 * r);
        P::subtract_product(x, c[r], part[j]);
        P::store(other + 8 * r, x);
      }
      other[k] = sign * part[j];
    }
#pragma GCC unroll 8
    for (int r = 0; r < packs; ++r) {
      if (8 * r == step) break;
      P::store(column + 8 * r, P::times(scaled[r], sign));
    }
    column[k] = -inverse;
    t.b[k] = sign * load;
    t.is_listed = false;
    set_state(t, k, !t.held[k]);
  }

  MOREAU_INLINE bool begin(SmallTableau& t) {
    for (Index r = 0; r < stride(t); r += 8) {
      whiten_block(t, r);
      mirror_block(t, r);
    }
    whiten_z(t);
    t.growth = 1;
    t.is_listed = false;
    for (Index r = 0; r < stride(t); r += 8) P::store(t.b + r, P::load(t.load + r));
    bool wanted[SmallTableau::most];
    for (Index a = 0; a < stride(t); ++a) {
      wanted[a] = a < t.m && (t.held[a] || t.two_sided[a]);
      set_state(t, a, false);
    }
    for (Index a = 0; a < t.m; ++a)
      if (wanted[a] && !is_nearly_dependent(t, a))
        sweep(t, a);
      else if (wanted[a] && t.two_sided[a])
        return false;
    return true;
  }

  MOREAU_INLINE bool begin_again(SmallTableau& t) {
    whiten_z(t);
    sweep_load(t, t.load);
    return true;
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
    double top[8], most;
    Pack best = P::load(x);
    for (Index r = 8; r < count; r += 8) best = P::larger(best, P::load(x + r));
    P::store(top, best);
    for (int half = 4; half > 0; half /= 2)
      for (int k = 0; k < half; ++k) top[k] = top[k] > top[k + half] ? top[k] : top[k + half];
    most = top[0];
    Index at = 0;
    while (at < count - 1 && !(x[at] >= most)) ++at;
    return at;
  }

  MOREAU_INLINE bool settle(SmallTableau& t) {
    t.dependent = -1;
    if (t.m > 0 && !pivot(t, t.load, t.z_norm)) return false;
    find_point(t);
    return true;
  }

  /// The dual method of Goldfarb and Idnani (1983) on the swept tableau: rows whose multiplier b is negative
  /// go, the most negative first; then the row violated most has its multiplier raised until it holds. Its
  /// column tells by how much all others change with it; those held whose multiplier comes down to 0 on the
  /// way go. norm: ||·|| of the whitened linear term that the load is of.
  MOREAU_INLINE bool pivot(SmallTableau& t, const double* load, double norm) {
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
      if (!(wrong[a] > GramPivoting::least_violation * norm)) return true;
      if (!(wrong[a] > GramPivoting::least_violation * (norm + std::sqrt(std::abs(P::total(energy))))))
        return true;
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
      const double least = zero_coefficient * t.row_scale[a];
      for (Index r = 0; r < stride(t); r += 8) {
        const Pack c = P::load(column + r);
        P::store(falls + r, P::where_larger(P::times(c, P::times(P::load(t.leave + r), -1)), least,
                                            P::times(P::over(P::load(t.b + r), c), -1), -infinite));
      }
      const Index first = largest(falls, stride(t));
      const double partial = falls[first] < 0 ? -falls[first] : 0;
      if (!dependent && t.b[a] <= partial * column[a]) {
        sweep(t, a);
        t.b[a] += raised;
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
        P::store(t.b + r, b);
      }
      t.b[first] = 0;
      sweep(t, first);
    }
    return false;
  }

  /// into := x + Σ_k weight_k u_k over the rows held.
  MOREAU_INLINE void add_rows(const SmallTableau& t, const double* weight, const double* x, double* into) {
    const double* const end = t.U + t.all * t.n;
    for (Index i = 0; i < ld(t); i += 8) {
      Pack sum = P::load(x + i);
      for (Index k = 0; k < t.size; ++k)
        P::add_product(sum, P::load_before(t.U + t.rows[k] * t.n + i, end), weight[k]);
      // Beyond n the sums have what stands behind the rows.
      P::store(into + i, P::first(sum, t.n - i));
    }
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

  /// Takes what b adds to the multipliers of the rows held into these.
  MOREAU_INLINE void take_multipliers(SmallTableau& t) {
    list_rows_held(t);
    for (Index k = 0; k < t.size; ++k) {
      const Index a = t.place[k];
      t.correction[k] = t.b[a];
      t.held_lambda[k] = t.lambda[a] += t.b[a];
    }
  }

  MOREAU_INLINE void find_point(SmallTableau& t) {
    for (Index r = 0; r < stride(t); r += 8) P::store(t.lambda + r, Pack{});
    take_multipliers(t);
    add_rows(t, t.held_lambda, t.z, t.w);
    K::forward(t.n, ld(t), t.T, t.inverse, t.w);
    t.acceleration_norm = std::sqrt(K::dot(ld(t), t.w, t.w));
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.q + i, P::load(t.w + i)); });
    K::backward(t.n, ld(t), t.T, t.inverse, t.q);
  }

  MOREAU_INLINE double margin(const SmallTableau& t) {
    Pack least = P::plus(Pack{}, infinite);
    for (Index r = 0; r < stride(t); r += 8) {
      const Pack leave = P::load(t.leave + r), enter = P::load(t.enter + r);
      // One of them is 0.
      const Pack scale = P::minus(enter, leave), sign = P::plus(enter, leave);
      const Pack size = P::where_larger(scale, 0, P::times(P::times(P::load(t.b + r), sign), -1), infinite);
      least = P::smaller(size, least);
    }
    double part[8];
    P::store(part, least);
    double found = part[0];
    for (int k = 1; k < 8; ++k) found = part[k] < found ? part[k] : found;
    return found;
  }

  /// Rows that are not weak stay on their side; `free_all` takes that back.
  MOREAU_INLINE void keep_all_but_weak(SmallTableau& t) {
    for (Index a = 0; a < t.m; ++a)
      if (!t.is_weak[a]) {
        t.leave[a] = t.enter[a] = 0;
      }
  }
  MOREAU_INLINE void free_all(SmallTableau& t) {
    for (Index a = 0; a < t.m; ++a) set_state(t, a, t.held[a]);
  }

  /// Multipliers of weak rows count as 0 here: what they are is found anew.
  MOREAU_INLINE bool correct(SmallTableau& t) {
    K::stationarity(t.n, t.A, t.q, t.all, t.U, t.size, t.rows, t.held_lambda, t.z, t.r);
    if (!t.is_first) {
      each(
          ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.dq + i, P::load(t.r + i)); });
      K::residual(t.n, t.A, t.q_low, t.all, t.U, 0, t.rows, t.held_lambda, t.dq, t.r);
    }
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.dq + i, P::load(t.r + i)); });
    K::forward(t.n, ld(t), t.T, t.inverse, t.dq);
    for (Index r = 0; r < stride(t); r += 8) {
      bool any = t.any_weak;
      for (Index k = r; k < r + 8; ++k) any |= t.held[k];
      if (!any) {
        P::store(t.rest + r, Pack{});
        continue;
      }
      K::precise_slacks(t.n, t.raw + r * t.n, t.q, t.level + r, t.rest + r);
      alignas(64) double moved[8];
      K::dots(t.n, t.whitened + r * t.n, t.dq, moved);
      Pack missing = P::plus(P::load(t.rest + r), P::load(moved));
      if (!t.is_first) {
        K::dots(t.n, t.raw + r * t.n, t.q_low, moved);
        missing = P::plus(missing, P::load(moved));
      }
      P::store(t.rest + r, P::times(missing, -1));
    }
    sweep_load(t, t.rest);
    if (t.any_weak) {
      keep_all_but_weak(t);
      const bool settled = pivot(t, t.rest, std::sqrt(K::dot(ld(t), t.dq, t.dq)));
      free_all(t);
      if (!settled) return false;
    }
    take_multipliers(t);
    add_rows(t, t.correction, t.r, t.dq);
    K::forward(t.n, ld(t), t.T, t.inverse, t.dq);
    t.first = std::sqrt(K::dot(ld(t), t.dq, t.dq));
    K::backward(t.n, ld(t), t.T, t.inverse, t.dq);
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) {
          Pack low = P::load(t.dq + i), q = P::load(t.q + i);
          if (!t.is_first) low = P::plus(P::load(t.q_low + i), low);
          P::store(t.q_low + i, P::two_sum(q, low));
          P::store(t.q + i, q);
        });
    return true;
  }

  MOREAU_INLINE void measure_precisely(SmallTableau& t) {
    for (Index r = 0; r < stride(t); r += 8) {
      K::precise_slacks(t.n, t.raw + r * t.n, t.q, t.level + r, t.slack + r);
      alignas(64) double low[8];
      K::dots(t.n, t.raw + r * t.n, t.q_low, low);
      P::store(t.slack + r, P::plus(P::load(t.slack + r), P::load(low)));
    }
  }

  MOREAU_INLINE void measure(SmallTableau& t) {
    for (Index r = 0; r < stride(t) && t.all <= SmallTableau::few_rows; r += 8) {
      K::dots(t.n, t.raw + r * t.n, t.q, t.slack + r);
      P::store(t.slack + r, P::minus(P::load(t.slack + r), P::load(t.level + r)));
    }
    K::residual(t.n, t.A, t.q, t.all, t.U, t.size, t.rows, t.held_lambda, t.z, t.r);
    K::forward(t.n, ld(t), t.T, t.inverse, t.r);
    t.stationarity = std::sqrt(K::dot(ld(t), t.r, t.r));
    Pack square{};
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) {
          const Pack q = P::load(t.q + i);
          P::add_products(square, P::times(q, P::load(t.diagonal + i)), q);
        });
    t.magnitude = std::sqrt(P::total(square));
  }
};

}  // namespace convex::inline pivoting
