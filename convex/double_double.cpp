#include "convex/double_double.hpp"
#include "convex/processor.hpp"

#include <array>
#include <cmath>

namespace convex {
namespace {

/// TwoProduct as the header has it.
struct PortableProduct {
  [[gnu::always_inline]] static inline double error(double a, double b, double) {
    return two_product(a, b).lo;
  }
};

/// By a fused multiply-add, which the processor has.
struct FusedProduct {
  [[gnu::always_inline]] static inline double error(double a, double b, double product) {
    return __builtin_fma(a, b, -product);
  }
};

template <class Product>
[[gnu::always_inline]] inline void accumulate(double a, double b, double a_times_b_low, double& hi,
                                              double& lo) {
  const double product = a * b, error = Product::error(a, b, product);
  const double sum = hi + product, part = sum - hi;
  lo += ((hi - (sum - part)) + (product - part)) + (error + a_times_b_low);
  hi = sum;
}

template <class Product>
[[gnu::always_inline]] inline void add_multiple_with(Index n, const double* x, DoubleDouble c,
                                                     double* __restrict hi, double* __restrict lo) {
  for (Index i = 0; i < n; ++i) accumulate<Product>(x[i], c.hi, x[i] * c.lo, hi[i], lo[i]);
}

template <class Product>
[[gnu::always_inline]] inline DoubleDouble dot_with(Index n, const double* x, const double* y_hi,
                                                    const double* y_lo) {
  constexpr Index lanes = 8;  // independent sums, so that the loop vectorises
  std::array<double, lanes> hi{}, lo{};
  Index i = 0;
  for (; i + lanes <= n; i += lanes)
    for (Index l = 0; l < lanes; ++l)
      accumulate<Product>(x[i + l], y_hi[i + l], x[i + l] * y_lo[i + l], hi[static_cast<std::size_t>(l)],
                          lo[static_cast<std::size_t>(l)]);
  for (std::size_t l = 0; i < n; ++i, ++l) accumulate<Product>(x[i], y_hi[i], x[i] * y_lo[i], hi[l], lo[l]);
  // In pairs: one after the other, the lanes would wait for each other longer than the loop takes.
  std::array<DoubleDouble, lanes> sum;
  for (std::size_t l = 0; l < lanes; ++l) sum[l] = two_sum(hi[l], lo[l]);
  for (std::size_t half = lanes / 2; half > 0; half /= 2)
    for (std::size_t l = 0; l < half; ++l) sum[l] = add(sum[l], sum[l + half]);
  return sum[0];
}

#if defined(__x86_64__) && !defined(__FMA__)
// The program runs on any x86-64; where the machine has fused multiply-add, these run instead.
[[gnu::target("avx2,fma")]] void add_multiple_fused(Index n, const double* x, DoubleDouble c, double* hi,
                                                    double* lo) {
  add_multiple_with<FusedProduct>(n, x, c, hi, lo);
}
[[gnu::target("avx2,fma")]] DoubleDouble dot_fused(Index n, const double* x, const double* y_hi,
                                                   const double* y_lo) {
  return dot_with<FusedProduct>(n, x, y_hi, y_lo);
}
const bool has_fused = processor() != Processor::any;
#endif

}  // namespace

void DoubleDoubleVector::add(const Vector& x) {
  for (Index i = 0; i < x.size(); ++i) {
    const DoubleDouble sum = convex::add({hi[i], lo[i]}, {x[i], 0});
    hi[i] = sum.hi;
    lo[i] = sum.lo;
  }
}

void add_multiple(Index n, const double* x, DoubleDouble c, double* sum_hi, double* sum_lo) {
#if defined(__x86_64__) && !defined(__FMA__)
  if (has_fused) return add_multiple_fused(n, x, c, sum_hi, sum_lo);
#endif
  add_multiple_with<PortableProduct>(n, x, c, sum_hi, sum_lo);
}

DoubleDouble dot(Index n, const double* x, const double* y_hi, const double* y_lo) {
#if defined(__x86_64__) && !defined(__FMA__)
  if (has_fused) return dot_fused(n, x, y_hi, y_lo);
#endif
  return dot_with<PortableProduct>(n, x, y_hi, y_lo);
}

}  // namespace convex
