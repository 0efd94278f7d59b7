#include "convex/prox_formulas/top_level.hpp"

#ifdef __x86_64__
#include <immintrin.h>
#endif

#include <cmath>
#include <memory>

#include "convex/double_double.hpp"
#include "convex/processor.hpp"
#include "convex/prox_formulas/clones.hpp"

namespace convex::prox_formulas {

namespace {

/// Values filtered with one bound before it is raised: enough to hide the division, few enough to stay near.
constexpr Index stretch = 256;

template <bool absolute>
[[gnu::always_inline]] inline double value_of(double z) {
  return absolute ? std::abs(z) : z;
}

template <bool absolute>
[[gnu::always_inline]] inline double largest(Index n, const double* z) {
  constexpr Index wide = 32;  // independent maxima, so that the loop vectorises
  double most[wide];
  for (double& m : most) m = value_of<absolute>(z[0]);
  Index i = 0;
  for (; i + wide <= n; i += wide)
    for (Index l = 0; l < wide; ++l) {
      const double v = value_of<absolute>(z[i + l]);
      most[l] = v > most[l] ? v : most[l];
    }
  for (; i < n; ++i) most[0] = std::max(most[0], value_of<absolute>(z[i]));
  double top = most[0];
  for (double m : most) top = std::max(top, m);
  return top;
}

MOREAU_CLONES double largest_signed(Index n, const double* z) { return largest<false>(n, z); }
MOREAU_CLONES double largest_absolute(Index n, const double* z) { return largest<true>(n, z); }

MOREAU_CLONES void excess_signed(Index n, const double* z, double top, double rest, double* __restrict x) {
  fill_entries(n, x, [=](Index i) {
    const double v = (z[i] - top) - rest;
    return v > 0 ? v : 0;
  });
}
MOREAU_CLONES void excess_absolute(Index n, const double* z, double top, double rest, double* __restrict x) {
  fill_entries(n, x, [=](Index i) {
    const double v = (std::abs(z[i]) - top) - rest;
    return v > 0 ? std::copysign(v, z[i]) : 0;
  });
}
MOREAU_CLONES double sum_absolute(Index n, const double* z) {
  return sum_entries(n, [=](Index i) { return std::abs(z[i]); });
}

/// Values that were kept, and their sum.
struct Kept {
  Index count = 0;
  double sum = 0;
};

/// Of v_i = z_i - top the ones above `bound` are written to `kept`, in order; kept may be z.
template <bool absolute>
Kept filter(Index n, const double* z, double top, double bound, double* kept) {
  Kept found;
  for (Index i = 0; i < n; ++i) {
    const double v = value_of<absolute>(z[i]) - top;
    kept[found.count] = v;
    found.count += v > bound;
    found.sum += v > bound ? v : 0;
  }
  return found;
}

/// As many values as `filter_wide` takes at a time, and so many places beyond the last it may write.
constexpr Index lanes = 8;

#ifdef __x86_64__
/// `filter` where the machine can squeeze a register.
template <bool absolute>
[[gnu::target("avx512f")]] Kept filter_wide(Index n, const double* z, double top, double bound,
                                            double* kept) {
  const __m512d tops = _mm512_set1_pd(top), bounds = _mm512_set1_pd(bound);
  __m512d sums = _mm512_setzero_pd();
  Kept found;
  for (Index i = 0; i < n; i += lanes) {
    const auto valid = static_cast<__mmask8>(n - i >= lanes ? 0xff : (1 << (n - i)) - 1);
    __m512d v = _mm512_maskz_loadu_pd(valid, z + i);
    if constexpr (absolute) v = _mm512_abs_pd(v);
    v = _mm512_sub_pd(v, tops);
    const __mmask8 above = _mm512_mask_cmp_pd_mask(valid, v, bounds, _CMP_GT_OQ);
    sums = _mm512_mask_add_pd(sums, above, sums, v);
    _mm512_storeu_pd(kept + found.count, _mm512_maskz_compress_pd(above, v));
    found.count += __builtin_popcount(above);
  }
  double parts[lanes];
  _mm512_storeu_pd(parts, sums);
  for (double part : parts) found.sum += part;
  return found;
}

template <bool absolute>
Kept filtered(Index n, const double* z, double top, double bound, double* kept) {
  static const bool wide = processor() == Processor::avx512;
  return (wide ? filter_wide<absolute> : filter<absolute>)(n, z, top, bound, kept);
}
#else
template <bool absolute>
Kept filtered(Index n, const double* z, double top, double bound, double* kept) {
  return filter<absolute>(n, z, top, bound, kept);
}
#endif

/// first + Σ v_i in twice the working precision, rounded once.
MOREAU_CLONES double sum_compensated(Index n, const double* v, double first) {
  constexpr Index wide = 32;  // independent sums, so that the loop vectorises
  double hi[wide] = {first}, lo[wide] = {};
  const auto take = [&](Index l, double term) {
    const double sum = hi[l] + term, part = sum - hi[l];
    lo[l] += (hi[l] - (sum - part)) + (term - part);
    hi[l] = sum;
  };
  Index i = 0;
  for (; i + wide <= n; i += wide)
    for (Index l = 0; l < wide; ++l) take(l, v[i + l]);
  for (; i < n; ++i) take(i % wide, v[i]);
  DoubleDouble sum;
  for (Index l = 0; l < wide; ++l) sum = add(sum, two_sum(hi[l], lo[l]));
  return sum.value();
}

/// Any set S of values gives (Σ_S v - total)/|S| <= level, so what lies below that can be dropped.
template <bool absolute>
Level level_of(const Vector& z, double total) {
  const Index n = z.size();
  const double top = absolute ? largest_absolute(n, z.data()) : largest_signed(n, z.data());
  const std::unique_ptr<double[]> kept(new double[static_cast<std::size_t>(n + lanes)]);
  Kept all;
  double bound = -total;  // S = {the largest}
  for (Index first = 0; first < n; first += stretch) {
    const Kept added = filtered<absolute>(std::min(stretch, n - first), z.data() + first, top, bound,
                                          kept.get() + all.count);
    if (added.count == 0) continue;
    all = {all.count + added.count, all.sum + added.sum};
    bound = std::max(bound, (all.sum - total) / static_cast<double>(all.count));
  }
  Index count = all.count;
  for (;;) {
    const Kept left = filtered<false>(count, kept.get(), 0, bound, kept.get());
    if (left.count == 0) return {top, -total};  // total is so small that its share underflows
    if (left.count == count) break;
    count = left.count;
    bound = std::max(bound, (left.sum - total) / static_cast<double>(count));
  }
  const double exact = sum_compensated(count, kept.get(), -total);
  return {top, exact / static_cast<double>(count)};
}

}  // namespace

Level top_level(const Vector& z, double total, Values values) {
  return values == Values::absolute_ones ? level_of<true>(z, total) : level_of<false>(z, total);
}

Vector above_level(const Vector& z, Level level, Values values) {
  Vector x(z.size());
  (values == Values::absolute_ones ? excess_absolute : excess_signed)(z.size(), z.data(), level.top,
                                                                      level.rest, x.data());
  return x;
}

double sum_of_absolutes(const Vector& z) { return sum_absolute(z.size(), z.data()); }

}  // namespace convex::prox_formulas
