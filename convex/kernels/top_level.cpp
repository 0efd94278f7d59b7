#include "convex/kernels/top_level.hpp"

#include <cmath>
#include <memory>

#include "convex/double_double.hpp"
#include "convex/kernels/clones.hpp"

namespace convex::kernels {

namespace {

/// Values filtered with one bound before it is raised: enough to hide the division, few enough to stay near.
constexpr Index block = 256;

template <bool absolute>
[[gnu::always_inline]] inline double value_of(double z) {
  return absolute ? std::abs(z) : z;
}

template <bool absolute>
[[gnu::always_inline]] inline double largest(Index n, const double* z) {
  constexpr Index lanes = 32;  // independent maxima, so that the loop vectorises
  double most[lanes];
  for (double& m : most) m = value_of<absolute>(z[0]);
  Index i = 0;
  for (; i + lanes <= n; i += lanes)
    for (Index l = 0; l < lanes; ++l) {
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
  for (Index i = 0; i < n; ++i) {
    const double v = (z[i] - top) - rest;
    x[i] = v > 0 ? v : 0;
  }
}
MOREAU_CLONES void excess_absolute(Index n, const double* z, double top, double rest, double* __restrict x) {
  for (Index i = 0; i < n; ++i) {
    const double v = (std::abs(z[i]) - top) - rest;
    x[i] = v > 0 ? std::copysign(v, z[i]) : 0;
  }
}

/// Of v_i = z_i - top the ones above `bound`, appended to `kept`; their number.
template <bool absolute>
Index filter(Index n, const double* z, double top, double bound, double* kept) {
  Index count = 0;
  for (Index i = 0; i < n; ++i) {
    const double v = value_of<absolute>(z[i]) - top;
    kept[count] = v;
    count += v > bound;
  }
  return count;
}

double sum_of(Index n, const double* v) { return Eigen::Map<const Vector>(v, n).sum(); }

/// Any set S of values gives (Σ_S v - total)/|S| <= level, so what lies below that can be dropped.
template <bool absolute>
Level level_of(const Vector& z, double total) {
  const Index n = z.size();
  const double top = absolute ? largest_absolute(n, z.data()) : largest_signed(n, z.data());
  const std::unique_ptr<double[]> kept(new double[static_cast<std::size_t>(n + 1)]);
  Index count = 0;
  double bound = -total, sum = 0;  // S = {the largest}
  for (Index first = 0; first < n; first += block) {
    const Index added =
        filter<absolute>(std::min(block, n - first), z.data() + first, top, bound, kept.get() + count);
    if (added == 0) continue;
    sum += sum_of(added, kept.get() + count);
    count += added;
    bound = std::max(bound, (sum - total) / static_cast<double>(count));
  }
  for (;;) {
    const Index left = filter<false>(count, kept.get(), 0, bound, kept.get());
    if (left == 0) return {top, -total};  // total is so small that its share underflows
    if (left == count) break;
    count = left;
    bound = std::max(bound, (sum_of(count, kept.get()) - total) / static_cast<double>(count));
  }
  DoubleDouble exact{-total, 0};
  for (Index i = 0; i < count; ++i) {
    const DoubleDouble s = two_sum(exact.hi, kept[static_cast<std::size_t>(i)]);
    exact = {s.hi, exact.lo + s.lo};
  }
  return {top, exact.value() / static_cast<double>(count)};
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

double sum_of_absolutes(const Vector& z) { return z.lpNorm<1>(); }

}  // namespace convex::kernels
