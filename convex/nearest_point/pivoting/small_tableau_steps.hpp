#pragma once

#include <cmath>

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
  using Pivots::infinite, Pivots::is_nearly_dependent, Pivots::list_working_set, Pivots::pivot, Pivots::sweep,
      Pivots::forget_pivots, Pivots::sweep_anew, Pivots::sweep_load;
  /// Beyond twice the working set and so many more, pivots are forgotten but for one for each of its rows.
  static constexpr Index few_pivots = 8;
  using Rows::each, Rows::ld, Rows::load_block, Rows::measure_block, Rows::set_outside, Rows::set_state,
      Rows::stride, Rows::take_block, Rows::whiten_blocks, Rows::whiten_z;

  MOREAU_INLINE void find_loads(SmallTableau& t) {
    whiten_z(t);
    for (Index r = 0; r < stride(t); r += 8) load_block(t, r);
  }

  MOREAU_INLINE bool begin(SmallTableau& t) {
    for (Index r = 0; r < stride(t); r += 8) take_block(t, r);
    whiten_blocks(t, 0);
    for (Index r = 0; r < stride(t); r += 8) measure_block(t, r);
    find_loads(t);
    forget_pivots(t);
    t.is_listed = false;
    for (Index r = 0; r < stride(t); r += 8) P::store(t.b + r, P::load(t.load + r));
    bool wanted[SmallTableau::most];
    for (Index a = 0; a < t.m; ++a) wanted[a] = t.held[a] || t.two_sided[a];
    for (Index r = 0; r < stride(t); r += 8) set_outside(t, r);
    for (Index a = 0; a < t.m; ++a)
      if (wanted[a] && !is_nearly_dependent(t, a))
        sweep(t, a);
      else if (wanted[a] && t.two_sided[a])
        return false;
    return true;
  }

  MOREAU_INLINE bool begin_again(SmallTableau& t) {
    find_loads(t);
    if (t.pivots > 2 * t.size + few_pivots) sweep_anew(t);
    sweep_load(t, t.load);
    return true;
  }

  MOREAU_INLINE bool settle(SmallTableau& t) {
    t.dependent = -1;
    if (t.m > 0 && !pivot(t, t.load, t.z_norm)) return false;
    find_point(t);
    return true;
  }

  /// x := x + Σ_k b_k v_k over the working set: L⁻¹ times the sum of the b_k u_k, with no triangle to solve.
  MOREAU_INLINE void add_whitened_rows(const SmallTableau& t, double* x) {
    alignas(64) double weight[SmallTableau::most];
    for (Index r = 0; r < stride(t); r += 8)
      P::store(weight + r, P::where_larger(P::load(t.share + r), 0, P::load(t.b + r), 0));
    const Index n = t.n;
    for (Index i = 0; i < ld(t); i += 8) {
      Pack sum[8];
      P::clear(sum);
      for (Index r = 0; r < stride(t); r += 8) {
        const Pack factor = P::load(weight + r);
        const double* const v = t.whitened + r * n + 8 * i;
#pragma GCC unroll 8
        for (int l = 0; l < 8; ++l)
          if (i + l < n) P::add_products(sum[l], P::load(v + 8 * l), factor);
      }
      P::store(x + i, P::plus(P::load(x + i), P::totals(sum)));
    }
  }

  /// Takes what b adds to the multipliers of the working set into these.
  MOREAU_INLINE void take_multipliers(SmallTableau& t) {
    list_working_set(t);
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
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.w + i, P::load(t.w_free + i)); });
    add_whitened_rows(t, t.w);
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
    add_whitened_rows(t, t.dq);
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
