#pragma once

#include <cstdint>
#include <memory>

#include "convex/processor.hpp"
#include "convex/vector.hpp"

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
