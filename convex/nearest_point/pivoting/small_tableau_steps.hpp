#pragma once

#include <cmath>

#include "convex/nearest_point/pivoting/critical_region.hpp"
#include "convex/nearest_point/pivoting/small_tableau_pivots.hpp"

namespace convex::inline pivoting {

/// `SmallKernels`, to be compiled for a processor family each. Packs of places as in `SmallTableauRows`.
template <int W, bool Fused, int packs>
struct SmallTableauSteps : SmallTableauPivots<W, Fused, packs> {
  using Rows = SmallTableauRows<W, Fused, packs>;
  using Pivots = SmallTableauPivots<W, Fused, packs>;
  using K = Kernels<W, Fused>;
  using P = Packs<W, Fused>;
  using Pack = typename P::Pack;
  using Pivots::infinite, Pivots::is_nearly_dependent, Pivots::list_rows_held, Pivots::pivot, Pivots::sweep,
      Pivots::sweep_load;
  using Rows::each, Rows::ld, Rows::load_block, Rows::mirror_block, Rows::set_state, Rows::stride,
      Rows::whiten_block, Rows::whiten_z;

  MOREAU_INLINE void find_loads(SmallTableau& t) {
    whiten_z(t);
    for (Index r = 0; r < stride(t); r += 8) load_block(t, r);
  }

  MOREAU_INLINE bool begin(SmallTableau& t) {
    for (Index r = 0; r < stride(t); r += 8) {
      whiten_block(t, r);
      mirror_block(t, r);
    }
    find_loads(t);
    t.sweep_growth = 1;
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
    find_loads(t);
    sweep_load(t, t.load);
    return true;
  }

  MOREAU_INLINE bool settle(SmallTableau& t) {
    t.dependent = -1;
    if (t.m > 0 && !pivot(t, t.load, t.z_norm)) return false;
    find_point(t);
    return true;
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

  /// Takes what b adds to the multipliers of the rows held into these.
  MOREAU_INLINE void take_multipliers(SmallTableau& t) {
    list_rows_held(t);
    for (Index k = 0; k < t.size; ++k) {
      const Index a = t.place[k];
      t.change[k] = t.b[a];
      const DoubleDouble sum = two_sum(t.lambda_at[a], t.lambda_low_at[a] + t.b[a]);
      t.lambda[k] = t.lambda_at[a] = sum.hi;
      t.lambda_low[k] = t.lambda_low_at[a] = sum.lo;
    }
  }

  MOREAU_INLINE void find_point(SmallTableau& t) {
    for (Index r = 0; r < stride(t); r += 8) {
      P::store(t.lambda_at + r, Pack{});
      P::store(t.lambda_low_at + r, Pack{});
    }
    take_multipliers(t);
    add_rows(t, t.lambda, t.z, t.w);
    K::forward(t.n, ld(t), t.T, t.inverse, t.w);
    t.acceleration_norm = std::sqrt(K::dot(ld(t), t.w, t.w));
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.q + i, P::load(t.w + i)); });
    K::backward(t.n, ld(t), t.T, t.inverse, t.q);
  }

  /// y + y_low of `count` packs from `first` on.
  template <int count>
  MOREAU_INLINE void apply(CriticalRegion& region, Index first) {
    Pack sum[count], low[count], rest[count];
    P::clear(sum), P::clear(low), P::clear(rest);
    for (Index j = 0; j < region.columns; ++j) {
      const double x = region.x[j];
      const Index at = j * region.stride + first;
#pragma GCC unroll 4
      for (int r = 0; r < count; ++r) {
        P::add_precisely(sum[r], low[r], P::load(region.high + at + 8 * r), x);
        P::add_product(rest[r], P::load(region.low + at + 8 * r), x);
      }
    }
#pragma GCC unroll 4
    for (int r = 0; r < count; ++r) {
      P::store(region.y_low + first + 8 * r, P::two_sum(sum[r], P::plus(low[r], rest[r])));
      P::store(region.y + first + 8 * r, sum[r]);
    }
  }

  MOREAU_INLINE void take_affine_point(SmallTableau& t, CriticalRegion& region, const double* z,
                                       const double* s) {
    const Index n = t.n;
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) {
          const Pack x = P::load_before(z + i, z + n);
          P::store(t.z + i, x);
          P::store(t.w_free + i, x);
          P::store(region.x + i, x);
        });
    const bool has_all = region.has_all = t.all <= SmallTableau::few_rows;
    for (Index r = 0; has_all && r < stride(t); r += 8)
      P::store(t.level + r, P::load_before(s + r, s + t.all));
    for (Index k = 0; k < t.size; ++k) region.x[n + k] = t.level[t.place[k]] = s[t.rows[k]];
    constexpr Index together = W == 8 ? 4 : 1;
    Index first = 0;
    for (; first + 8 * (together - 1) < region.stride; first += 8 * together) apply<together>(region, first);
    for (; first < region.stride; first += 8) apply<1>(region, first);

    Pack sum[8], least = P::plus(Pack{}, infinite);  // of missing, rounded, ‖q‖_D, ‖q‖_A, ‖z‖, ‖Aq - ...‖
    P::clear(sum);
    for (Index i = 0; i < region.stride; i += 8) {
      const Pack x = P::load(region.x + i), y = P::load(region.y + i), length = P::load(region.length + i);
      P::add_products(sum[0], K::size(x), P::load(region.error + i));
      const Pack size = P::larger(P::times(y, length), P::times(y, P::load(region.pull + i)));
      least = P::smaller(P::where_larger(length, 0, size, infinite), least);
    }
    for (Index k = 0; k < t.size; ++k) t.lambda[k] = region.y[n + k];
    for (Index i = 0; i < ld(t); i += 8) {
      const Pack q = P::first(P::load(region.y + i), n - i), low = P::first(P::load(region.y_low + i), n - i),
                 diagonal = P::load(t.diagonal + i);
      P::store(t.q + i, q);
      P::store(t.q_low + i, low);
      P::add_products(sum[1], P::times(low, diagonal), low);
      P::add_products(sum[2], P::times(q, diagonal), q);
      Pack w = P::load(t.z + i);
      for (Index k = n; k < region.columns; ++k)
        P::add_product(w, P::load(region.balance + k * ld(t) + i), region.y[k]);
      P::store(t.w + i, w);
      for (Index j = 0; j < n; ++j)
        P::subtract_product(w, P::load(region.balance + j * ld(t) + i), region.y[j]);
      P::store(t.r + i, w);
    }
    K::forward(n, ld(t), t.T, t.inverse, t.w);
    K::forward(n, ld(t), t.T, t.inverse, t.w_free);
    K::forward(n, ld(t), t.T, t.inverse, t.r);
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) {
          const Pack w = P::load(t.w + i), free = P::load(t.w_free + i), r = P::load(t.r + i);
          P::add_products(sum[3], w, w);
          P::add_products(sum[4], free, free);
          P::add_products(sum[5], r, r);
        });
    for (Index r = 0; has_all && r < stride(t); r += 8) {
      K::dots(n, t.raw + r * n, t.q, t.slack_at + r);
      const Pack level = P::load(t.level + r), slack = P::minus(P::load(t.slack_at + r), level),
                 enter = P::load(t.enter + r);
      P::store(t.slack_at + r, slack);
      const Pack clear = P::times(P::minus(slack, P::times(K::size(level), near_zero)), enter);
      least = P::smaller(P::where_larger(enter, 0, clear, infinite), least);
      P::add_product(sum[6], clear, 0);  // not 0 where a level is not finite
    }
    alignas(64) double total[8];
    P::store(total, P::totals(sum));
    region.remaining = total[0];
    region.rounded = std::sqrt(total[1]);
    t.magnitude = std::sqrt(total[2]);
    t.acceleration_norm = std::sqrt(total[3]);
    t.z_norm = std::sqrt(total[4]);
    t.stationarity = std::sqrt(total[5]);
    region.least = total[6] - K::largest(P::times(least, -1));
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
    K::stationarity(t.n, t.A, t.q, t.all, t.U, t.size, t.rows, t.lambda, t.z, t.r);
    if (!t.is_first) {
      each(
          ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.dq + i, P::load(t.r + i)); });
      K::residual(t.n, t.A, t.q_low, t.all, t.U, t.size, t.rows, t.lambda_low, t.dq, t.r);
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
    add_rows(t, t.change, t.r, t.dq);
    K::forward(t.n, ld(t), t.T, t.inverse, t.dq);
    t.step = std::sqrt(K::dot(ld(t), t.dq, t.dq));
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

  MOREAU_INLINE void measure(SmallTableau& t) {
    for (Index r = 0; r < stride(t) && t.all <= SmallTableau::few_rows; r += 8) {
      K::dots(t.n, t.raw + r * t.n, t.q, t.slack_at + r);
      P::store(t.slack_at + r, P::minus(P::load(t.slack_at + r), P::load(t.level + r)));
    }
    Pack square{};
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) {
          const Pack q = P::load(t.q + i);
          P::add_products(square, P::times(q, P::load(t.diagonal + i)), q);
        });
    t.magnitude = std::sqrt(P::total(square));
  }

  MOREAU_INLINE void measure_balance(SmallTableau& t) {
    K::residual(t.n, t.A, t.q, t.all, t.U, t.size, t.rows, t.lambda, t.z, t.r);
    K::forward(t.n, ld(t), t.T, t.inverse, t.r);
    t.stationarity = std::sqrt(K::dot(ld(t), t.r, t.r));
  }
};

}  // namespace convex::inline pivoting
