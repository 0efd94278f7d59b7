#pragma once

#include <cstdint>
#include <memory>

#include "convex/vector.hpp"

/// Loops so marked are compiled for several generations of x86-64 and the best is chosen when the program
/// starts, so that one binary runs anywhere at the machine's speed. Features are named, not processors: a
/// named processor would match no newer one. Entry by entry the results are the same bit by bit, for products
/// and sums are not contracted.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define MOREAU_CLONES [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define MOREAU_CLONES
#endif

namespace convex::prox_formulas {

/// x_i = entry(i), i < n, within a loop of MOREAU_CLONES. Results are stored to whole cache lines, and
/// several at a time, without which the loop is slower than a copy by more than its arithmetic.
template <class Entry>
[[gnu::always_inline]] inline void fill_entries(Index n, double* __restrict x, Entry entry) {
  constexpr Index line = 64, lanes = 32;
  const auto misplaced = static_cast<Index>(reinterpret_cast<std::uintptr_t>(x) % line);
  const Index head = std::min(n, (line - misplaced) % line / Index{sizeof(double)});
  Index i = 0;
  for (; i < head; ++i) x[i] = entry(i);
  for (; i + lanes <= n; i += lanes) {
    double* const aligned = std::assume_aligned<line>(x + i);
    for (Index l = 0; l < lanes; ++l) aligned[l] = entry(i + l);
  }
  for (; i < n; ++i) x[i] = entry(i);
}

/// Σ entry(i), i < n, within a loop of MOREAU_CLONES.
template <class Entry>
[[gnu::always_inline]] inline double sum_entries(Index n, Entry entry) {
  constexpr Index lanes = 32;  // independent sums, so that the loop vectorises and errors grow slowly
  double sums[lanes] = {};
  Index i = 0;
  for (; i + lanes <= n; i += lanes)
    for (Index l = 0; l < lanes; ++l) sums[l] += entry(i + l);
  for (; i < n; ++i) sums[i % lanes] += entry(i);
  for (Index half = lanes / 2; half > 0; half /= 2)
    for (Index l = 0; l < half; ++l) sums[l] += sums[l + half];
  return sums[0];
}

}  // namespace convex::prox_formulas
