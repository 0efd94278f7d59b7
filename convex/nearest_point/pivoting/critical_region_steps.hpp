#pragma once

#include <cmath>

#include "convex/dense/pack_kernels.hpp"
#include "convex/nearest_point/pivoting/critical_region.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {

/// The point of a `CriticalRegion`, one product and what is measured at it. Packs of coordinates: 1, so that
/// loops over them vanish; else 4, which stands for any number.
template <int W, bool Fused, int packs>
struct CriticalRegionSteps : Kernels<W, Fused> {
  using K = Kernels<W, Fused>;
  using P = Packs<W, Fused>;
  using Pack = typename P::Pack;
  static constexpr double infinite = __builtin_inf();

  MOREAU_INLINE Index ld(const CriticalRegion& region) { return packs == 1 ? 8 : region.p.ld; }

  /// Takes in z and s_S, in their units, and splits them. The largest. Entries of s go by themselves: a pack
  /// would wait until they have reached the memory.
  MOREAU_INLINE double take_column(CriticalRegion& region, const double* z, const double* s) {
    const GramPoint& p = region.p;
    const Index n = p.n;
    Pack most{};
    for (Index i = 0; i < ld(region); i += 8) {
      const Pack x = P::load_before(z + i, z + n), size = K::size(P::times(x, P::load(region.unit + i)));
      P::store(p.z + i, x);
      most = i > 0 ? P::larger(most, size) : size;
    }
    double largest = 0;
    for (Index k = 0; k < p.size; ++k) {
      const double x = std::abs(s[p.rows[k]] * region.unit[n + k]);
      largest = largest > x ? largest : x;
    }
    const double of_z = K::largest(most);
    largest = largest > of_z ? largest : of_z;
    const double shift = CriticalRegion::leaves_leading * largest;
    for (Index i = 0; i < ld(region); i += 8) {
      const Pack x = P::times(P::load(p.z + i), P::load(region.unit + i)),
                 leading = P::plus(P::plus(x, shift), -shift);
      P::store(region.x + i, x);
      P::store(region.x_leading + i, leading);
      P::store(region.x_rest + i, P::minus(x, leading));
    }
    for (Index k = 0; k < p.size; ++k) {
      const double x = s[p.rows[k]] * region.unit[n + k], leading = (x + shift) - shift;
      region.x[n + k] = x;
      region.x_leading[n + k] = leading;
      region.x_rest[n + k] = x - leading;
    }
    return largest;
  }

  /// y + y_low of `count` packs from `first` on.
  template <int count>
  MOREAU_INLINE void apply(CriticalRegion& region, Index first) {
    Pack sum[2][count], low[2][count], rest[2][count];
    for (int odd = 0; odd < 2; ++odd) P::clear(sum[odd]), P::clear(low[odd]), P::clear(rest[odd]);
    const auto add = [&](int odd, Index j) __attribute__((always_inline)) {
#pragma GCC unroll 4
      for (int r = 0; r < count; ++r) {
        const double* const entries = region.split + 16 * ((first / 8 + r) * region.columns + j);
        const Pack leading = P::load(entries);
        P::add_product(sum[odd][r], leading, region.x_leading[j]);
        P::add_product(low[odd][r], leading, region.x_rest[j]);
        P::add_product(rest[odd][r], P::load(entries + 8), region.x[j]);
      }
    };
    Index j = 0;
    for (; j + 2 <= region.columns; j += 2) add(0, j), add(1, j + 1);
    if (j < region.columns) add(0, j);
#pragma GCC unroll 4
    for (int r = 0; r < count; ++r) {
      const Pack beside = P::plus(P::plus(low[0][r], low[1][r]), P::plus(rest[0][r], rest[1][r]));
      Pack y = P::plus(sum[0][r], sum[1][r]);
      P::store(region.y_low + first + 8 * r, P::two_sum(y, beside));
      P::store(region.y + first + 8 * r, y);
    }
  }

  /// ||V lambda||², V the v_k over the working set.
  MOREAU_INLINE Pack pushes(const CriticalRegion& region) {
    const GramPoint& p = region.p;
    Pack square{};
    for (Index r = 0; r < p.size; r += 8) {
      Pack sum[2];
      P::clear(sum);
      const double* column = region.gram + r;
      Index k = 0;
      for (; k + 2 <= p.size; k += 2, column += 2 * padded(p.size)) {
        P::add_product(sum[0], P::load(column), p.lambda[k]);
        P::add_product(sum[1], P::load(column + padded(p.size)), p.lambda[k + 1]);
      }
      if (k < p.size) P::add_product(sum[0], P::load(column), p.lambda[k]);
      P::add_products(square, P::plus(sum[0], sum[1]), P::load(p.lambda + r));
    }
    return square;
  }

  /// Work on all of `size` doubles, by as many packs at once as registers allow.
  template <class Work>
  MOREAU_INLINE void by_packs(Index size, Work work) {
    Index first = 0;
    if constexpr (W == 8 && packs > 1) {
      for (; first + 32 <= size; first += 32) work.template operator()<4>(first);
      if (first + 16 <= size) {
        work.template operator()<2>(first);
        first += 16;
      }
    }
    for (; first < size; first += 8) work.template operator()<1>(first);
  }

  /// The norms of q and z by those sums; of z by itself where these cancel, as where it is 0.
  MOREAU_INLINE void measure_norms(CriticalRegion& region, double of_z, double of_rows, double of_pushes) {
    constexpr double much = 0x1p-20;
    GramPoint& p = region.p;
    const double q_square = of_z + of_rows, z_square = of_z - of_rows + of_pushes;
    p.acceleration_norm = q_square < 0 ? 0 : std::sqrt(q_square);
    if (z_square > much * of_pushes) {
      p.z_norm = std::sqrt(z_square);
      return;
    }
    for (Index i = 0; i < ld(region); i += 8) P::store(p.w_free + i, P::load(p.z + i));
    K::forward(p.n, ld(region), p.T, p.inverse, p.w_free);
    p.z_norm = std::sqrt(K::dot(ld(region), p.w_free, p.w_free));
  }

  /// Beside A q = z + Uᵀlambda, with V = L⁻¹U_Sᵀ and w_free = L⁻¹z, is L⁻¹A q = w_free + V lambda; so
  /// ||q||_A² = q·z + lambda·s_S and ||w_free||² = q·z - lambda·s_S + ||V lambda||². What the printed numbers
  /// miss of these equations is A q_low - Uᵀlambda_low, and what remains.
  MOREAU_INLINE void take_affine_point(CriticalRegion& region, const double* z, const double* s) {
    GramPoint& p = region.p;
    const Index n = p.n, rows_beside = region.has_all ? padded(p.all) : 0;
    for (Index r = 0; r < rows_beside; r += 8) P::store(region.level + r, P::load_before(s + r, s + p.all));
    const double largest = take_column(region, z, s);
    by_packs(
        region.stride, [&]<int count>(Index first)
                           __attribute__((always_inline)) { apply<count>(region, first); });

    double of_rows = 0;  // lambda·s_S
    for (Index k = 0; k < p.size; ++k) {
      p.lambda[k] = region.y[n + k];
      of_rows += p.lambda[k] * s[p.rows[k]];
    }
    // Sums: what is missing, ‖q_low‖_D², ‖q‖_D², q·z, ‖V lambda‖², what the equations miss, whether all is
    // finite.
    Pack sum[8], least = P::plus(Pack{}, infinite);
    P::clear(sum);
    for (Index i = 0; i < region.stride; i += 8) {
      const Pack x = P::load(region.x + i), y = P::load(region.y + i), length = P::load(region.length + i);
      P::add_products(sum[0], K::size(x), P::load(region.error + i));
      P::add_products(sum[5], K::size(P::load(region.y_low + i)), length);
      const Pack size = P::larger(P::times(y, length), P::times(y, P::load(region.pull + i)));
      least = P::smaller(P::where_larger(length, 0, size, infinite), least);
    }
    for (Index i = 0; i < ld(region); i += 8) {
      const Pack q = P::first(P::load(region.y + i), n - i), low = P::first(P::load(region.y_low + i), n - i),
                 diagonal = P::load(p.diagonal + i);
      P::store(p.q + i, q);
      P::add_products(sum[1], P::times(low, diagonal), low);
      P::add_products(sum[2], P::times(q, diagonal), q);
      P::add_products(sum[3], q, P::load(p.z + i));
    }
    sum[4] = pushes(region);
    for (Index r = 0; r < rows_beside; r += 8) {
      K::dots(n, region.raw + r * n, p.q, p.slack + r);
      const Pack level = P::load(region.level + r), slack = P::minus(P::load(p.slack + r), level),
                 enter = P::load(region.enter + r);
      P::store(p.slack + r, slack);
      const Pack clear = P::times(P::minus(slack, P::times(K::size(level), near_zero)), enter);
      least = P::smaller(P::where_larger(enter, 0, clear, infinite), least);
      P::add_product(sum[6], clear, 0);  // not 0 where a level is not finite
    }
    alignas(64) double total[8], root[8];
    const Pack totals = P::totals(sum);
    P::store(total, totals);
    P::store(root, P::root(totals));
    region.remaining = total[0] + region.error_of_sums * largest;
    region.rounded = root[1];
    p.magnitude = root[2];
    p.stationarity = total[5] + 2 * region.remaining;
    measure_norms(region, total[3], of_rows, total[4]);
    region.least = total[6] - K::largest(P::times(least, -1));
  }
};

}  // namespace convex::inline pivoting
