#pragma once

#include <cmath>

#include "convex/dense/pack_kernels.hpp"
#include "convex/nearest_point/pivoting/gram_pivoting.hpp"
#include "convex/nearest_point/pivoting/small_tableau.hpp"

namespace convex {

/// A row entering of which less than this part, squared, lies outside the span of those held is nearly
/// dependent, and left to `GramSolve`.
inline constexpr double nearly_dependent = 1e-6;

/// `SmallKernels`, to be compiled for a processor family each. Packs: one when n and m are at most 8, so that
/// loops over packs vanish; 4 otherwise.
template <int W, bool Fused, int packs>
struct SmallTableauSteps : Kernels<W, Fused> {
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

  MOREAU_INLINE void whiten_force(SmallTableau& t) {
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.w_free + i, P::load(t.z + i)); });
    K::forward(t.n, ld(t), t.T, t.inverse, t.w_free);
    t.force_norm = std::sqrt(K::dot(ld(t), t.w_free, t.w_free));
    for (Index r = 0; r < stride(t); r += 8) {
      K::dots(t.n, t.whitened + r * t.n, t.w_free, t.load + r);
      P::store(t.load + r, P::minus(P::load(t.level + r), P::load(t.load + r)));
    }
  }

  MOREAU_INLINE void whiten_rows(SmallTableau& t) {
    for (Index r = 0; r < stride(t); r += 8) {
      double* const raw = t.raw + r * t.n;
      const Index count = t.m - r < 8 ? t.m - r : 8;
      if (count < 8) fill_packs(8 * t.n, 0, raw);
      for (Index k = 0; k < count; ++k) {
        const double* const u = t.U + (r + k) * t.n;
        for (Index i = 0; i < t.n; ++i) raw[8 * i + k] = u[i];
      }
      double* const whitened = t.whitened + r * t.n;
      Pack scale{};
      for (Index i = 0; i < t.n; ++i) {
        const Pack u = P::load(raw + 8 * i);
        P::store(whitened + 8 * i, u);
        P::add_products(scale, P::times(u, t.inverse_diagonal[i]), u);
      }
      P::store(t.row_scale + r, scale);
      K::forward_pack(t.n, ld(t), t.T, t.inverse, whitened);
      for (Index other = 0; other <= r; other += 8) {
        K::gram(t.n, t.whitened + other * t.n, whitened, t.swept + r * stride(t) + other, stride(t));
        if (other < r)
          for (Index k = 0; k < 8; ++k)
            for (Index l = 0; l < 8; ++l)
              t.swept[(other + k) * stride(t) + r + l] = t.swept[(r + l) * stride(t) + other + k];
      }
    }
    for (Index a = 0; a < stride(t); ++a) {
      t.row_scale[a] = std::sqrt(t.row_scale[a]);
      t.inverse_scale[a] = t.row_scale[a] > 0 ? 1 / t.row_scale[a] : 0;
      t.square[a] = t.swept[a * (stride(t) + 1)];
    }
  }

  MOREAU_INLINE void set_state(SmallTableau& t, Index a, bool held) {
    t.held[a] = held;
    t.share[a] = held ? 1 : 0;
    const bool may_leave = held && !t.two_sided[a];
    t.leave[a] = may_leave ? -t.row_scale[a] : 0;
    t.stay[a] = may_leave ? 0 : 1;
    t.enter[a] = held ? 0 : t.inverse_scale[a];
  }

  /// Takes row k in or out. False when it is nearly dependent on those held.
  MOREAU_INLINE bool sweep(SmallTableau& t, Index k) {
    const Index step = stride(t);
    double* const column = t.swept + k * step;
    const double pivot = column[k], inverse = 1 / pivot, sign = t.held[k] ? -1 : 1;
    if (!t.held[k] && !(pivot > nearly_dependent * t.square[k])) {
      if (!(pivot > GramPivoting::dependence * t.square[k])) t.dependent = k;
      return false;
    }
    const double growth = t.held[k] ? -pivot * t.square[k] : t.square[k] * inverse;
    t.growth = growth > t.growth ? growth : t.growth;
    alignas(64) double part[SmallTableau::most];
    Pack c[packs], scaled[packs];
    const double load = t.b[k] * inverse;
    for (Index r = 0; r < step; r += 8) {
      c[r / 8] = P::load(column + r);
      scaled[r / 8] = P::times(c[r / 8], inverse);
      P::store(part + r, scaled[r / 8]);
      Pack b = P::load(t.b + r);
      P::subtract_product(b, c[r / 8], load);
      P::store(t.b + r, b);
    }
    for (Index j = 0; j < t.m; ++j) {
      double* const other = t.swept + j * step;
#pragma GCC unroll 4
      for (int r = 0; r < packs; ++r) {
        if (8 * r == step) break;
        Pack x = P::load(other + 8 * r);
        P::subtract_product(x, c[r], part[j]);
        P::store(other + 8 * r, x);
      }
      other[k] = sign * part[j];
    }
    for (Index r = 0; r < step; r += 8) P::store(column + r, P::times(scaled[r / 8], sign));
    column[k] = -inverse;
    t.b[k] = sign * load;
    set_state(t, k, !t.held[k]);
    return true;
  }

  MOREAU_INLINE bool begin(SmallTableau& t) {
    whiten_rows(t);
    whiten_force(t);
    t.growth = 1;
    for (Index r = 0; r < stride(t); r += 8) P::store(t.b + r, P::load(t.load + r));
    bool wanted[SmallTableau::most];
    for (Index a = 0; a < stride(t); ++a) {
      wanted[a] = a < t.m && (t.held[a] || t.two_sided[a]);
      set_state(t, a, false);
    }
    for (Index a = 0; a < t.m; ++a)
      if (wanted[a] && !sweep(t, a) && t.two_sided[a]) return false;
    return true;
  }

  MOREAU_INLINE bool begin_again(SmallTableau& t) {
    whiten_force(t);
    sweep_load(t, t.load);
    return true;
  }

  /// b := the load as the sweeps have changed it.
  MOREAU_INLINE void sweep_load(SmallTableau& t, const double* load) {
    for (Index r = 0; r < stride(t); r += 8) P::store(t.b + r, P::load(load + r));
    for (Index a = 0; a < t.m; ++a)
      if (t.held[a]) t.b[a] = 0;
    for (Index a = 0; a < t.m; ++a)
      if (t.held[a])
        for (Index r = 0; r < stride(t); r += 8) {
          Pack b = P::load(t.b + r);
          P::subtract_product(b, P::load(t.swept + a * stride(t) + r), load[a]);
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
    t.steps = 0;
    t.dependent = -1;
    if (!pivot(t, t.load, t.force_norm)) return false;
    find_point(t);
    return true;
  }

  /// Sweeps until no multiplier b that may leave is negative and no row that may enter is violated. norm:
  /// ||·|| of the whitened force that the load is of.
  MOREAU_INLINE bool pivot(SmallTableau& t, const double* load, double norm) {
    const Index patience = t.steps + 4 * t.m + 8;
    for (;; ++t.steps) {
      alignas(64) double out[SmallTableau::most], in[SmallTableau::most];
      Pack energy{};
      for (Index r = 0; r < stride(t); r += 8) {
        const Pack b = P::load(t.b + r), enter = P::times(b, P::load(t.enter + r));
        P::store(in + r, enter);
        P::store(out + r, P::minus(P::times(b, P::load(t.leave + r)), P::load(t.stay + r)));
        P::add_products(energy, P::times(b, P::load(t.share + r)), P::load(load + r));
      }
      Index a = largest(out, stride(t));
      if (!(out[a] >= 0)) {
        a = largest(in, stride(t));
        if (!(in[a] > GramPivoting::least_violation * norm)) break;
        const double scale = GramPivoting::least_violation * (norm + std::sqrt(std::abs(P::total(energy))));
        if (!(in[a] > scale)) break;
      }
      if (t.steps == patience || !sweep(t, a)) return false;
    }
    return true;
  }

  /// sum += Σ_k weight_k u_k over the rows held.
  MOREAU_INLINE void add_rows(const SmallTableau& t, const double* weight, double* sum) {
    const double* const end = t.U + t.m * t.n;
    for (Index k = 0; k < t.size; ++k)
      for (Index i = 0; i < ld(t); i += 8) {
        Pack x = P::load(sum + i);
        P::add_product(x, P::load_before(t.U + t.rows[k] * t.n + i, end), weight[k]);
        P::store(sum + i, x);
      }
  }

  /// Lists the rows held, and takes what b adds to their multipliers into these.
  MOREAU_INLINE void list_rows_held(SmallTableau& t) {
    t.size = 0;
    double squares = 0;
    t.gram_condition = 0;
    for (Index a = 0; a < t.m; ++a) {
      if (!t.held[a]) continue;
      t.correction[t.size] = t.b[a];
      t.held_lambda[t.size] = t.lambda[a] += t.b[a];
      t.rows[t.size++] = a;
      squares -= t.swept[a * (stride(t) + 1)];
      t.gram_condition -= t.swept[a * (stride(t) + 1)] * t.square[a];
    }
    t.inverse_norm = std::sqrt(squares);
  }

  MOREAU_INLINE void find_point(SmallTableau& t) {
    for (Index r = 0; r < stride(t); r += 8) P::store(t.lambda + r, Pack{});
    list_rows_held(t);
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.w + i, P::load(t.z + i)); });
    add_rows(t, t.held_lambda, t.w);
    // Beyond n the sums have what stands behind the rows.
    for (Index i = t.n; i < ld(t); ++i) t.w[i] = 0;
    K::forward(t.n, ld(t), t.T, t.inverse, t.w);
    t.acceleration_norm = std::sqrt(K::dot(ld(t), t.w, t.w));
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.q + i, P::load(t.w + i)); });
    K::backward(t.n, ld(t), t.T, t.inverse, t.q);
  }

  /// Rows that are not weak stay on their side; `free_all` takes that back.
  MOREAU_INLINE void keep_all_but_weak(SmallTableau& t) {
    for (Index a = 0; a < t.m; ++a)
      if (!t.is_weak[a]) {
        t.leave[a] = t.enter[a] = 0;
        t.stay[a] = 1;
      }
  }
  MOREAU_INLINE void free_all(SmallTableau& t) {
    for (Index a = 0; a < t.m; ++a) set_state(t, a, t.held[a]);
  }

  /// Multipliers of weak rows count as 0 here: what they are is found anew.
  MOREAU_INLINE bool correct(SmallTableau& t) {
    K::stationarity(t.n, t.A, t.q, t.m, t.U, t.size, t.rows, t.held_lambda, t.z, t.r);
    if (!t.is_first) {
      each(
          ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.dq + i, P::load(t.r + i)); });
      K::residual(t.n, t.A, t.q_low, t.m, t.U, 0, t.rows, t.held_lambda, t.dq, t.r);
    }
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.dq + i, P::load(t.r + i)); });
    K::forward(t.n, ld(t), t.T, t.inverse, t.dq);
    for (Index r = 0; r < stride(t); r += 8) {
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
    list_rows_held(t);
    add_rows(t, t.correction, t.r);
    for (Index i = t.n; i < ld(t); ++i) t.r[i] = 0;
    each(
        ld(t), [&](Index i) __attribute__((always_inline)) { P::store(t.dq + i, P::load(t.r + i)); });
    K::forward(t.n, ld(t), t.T, t.inverse, t.dq);
    t.first = std::sqrt(K::dot(ld(t), t.dq, t.dq));
    K::backward(t.n, ld(t), t.T, t.inverse, t.dq);
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
    for (Index r = 0; r < stride(t); r += 8) {
      K::dots(t.n, t.raw + r * t.n, t.q, t.slack + r);
      P::store(t.slack + r, P::minus(P::load(t.slack + r), P::load(t.level + r)));
    }
    K::residual(t.n, t.A, t.q, t.m, t.U, t.size, t.rows, t.held_lambda, t.z, t.r);
    for (Index i = t.n; i < ld(t); ++i) t.r[i] = 0;
    K::forward(t.n, ld(t), t.T, t.inverse, t.r);
    t.stationarity = std::sqrt(K::dot(ld(t), t.r, t.r));
  }
};

}  // namespace convex
