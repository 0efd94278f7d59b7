#include "convex/dense/dense_kernels.hpp"

#include <cmath>

#include "convex/dense/pack_kernels.hpp"
#include "convex/processor.hpp"

namespace convex::inline dense {

namespace {

// Each step waits for the one before: put into vectors, as the compiler would, it waits for their entries
// too.
template <int width>
[[gnu::optimize("no-tree-slp-vectorize"), gnu::noinline]] void factor_columns(double* C) {
#pragma GCC unroll 8
  for (int c = 0; c < width; ++c) {
    const double pivot = C[9 * c], inverse = 1 / pivot, root = std::sqrt(std::max(pivot, 0.0)), r = 1 / root;
    double part[8];
#pragma GCC unroll 8
    for (int i = c + 1; i < width; ++i) part[i] = C[8 * c + i] * inverse;
#pragma GCC unroll 8
    for (int d = c + 1; d < width; ++d)
#pragma GCC unroll 8
      for (int i = d; i < width; ++i) C[8 * d + i] -= C[8 * c + i] * part[d];
    C[9 * c] = root;
#pragma GCC unroll 8
    for (int i = c + 1; i < width; ++i) C[8 * c + i] *= r;
  }
}

}  // namespace

void factor_block(Index width, double* C) {
  static constexpr void (*by_width[])(double*) = {factor_columns<1>, factor_columns<2>, factor_columns<3>,
                                                  factor_columns<4>, factor_columns<5>, factor_columns<6>,
                                                  factor_columns<7>, factor_columns<8>};
  by_width[width - 1](C);
}

namespace {

template <int W, class K>
constexpr DenseKernels table{Compiled<W, &K::factor>::at,
                             Compiled<W, &K::invert_blocks>::at,
                             Compiled<W, &K::forward>::at,
                             Compiled<W, &K::backward>::at,
                             Compiled<W, &K::forward_pack>::at,
                             Compiled<W, &K::backward_pack>::at,
                             Compiled<W, &K::gram>::at,
                             Compiled<W, &K::dots>::at,
                             Compiled<W, &K::combine>::at,
                             Compiled<W, &K::add_multiple>::at,
                             Compiled<W, &K::dot>::at,
                             Compiled<W, &K::slacks>::at,
                             Compiled<W, &K::squares>::at,
                             Compiled<W, &K::stationarity>::at,
                             Compiled<W, &K::residual>::at,
                             Compiled<W, &K::precise_slacks>::at,
                             Compiled<W, &K::add_columns>::at,
                             Compiled<W, &K::side_by_side>::at,
                             Compiled<W, &K::whole_sums>::at,
                             Compiled<W, &K::cancels>::at,
                             Compiled<W, &K::first_entries_differ_from_zero>::at,
                             Compiled<W, &K::largest_size>::at,
                             Compiled<W, &K::is_on_grid>::at,
                             Compiled<W, &K::is_finite>::at,
                             Compiled<W, &K::take_symmetric>::at};

const DenseKernels* const tables[] = {&table<2, Kernels<2, false>>,
#ifdef MOREAU_HAS_FAMILIES
                                      &table<4, Kernels<4, true>>, &table<8, Kernels<8, true>>
#endif
};

constinit const DenseKernels* chosen =
    &table<2, Kernels<2, false>>;  // until the choice is made, as the program starts
[[maybe_unused]] const bool made = (chosen = tables[static_cast<std::size_t>(processor())], true);

}  // namespace

const DenseKernels& dense_kernels() { return *chosen; }

std::span<const DenseKernels* const> all_dense_kernels() {
  return {tables, static_cast<std::size_t>(processor()) + 1};
}

}  // namespace convex::inline dense
