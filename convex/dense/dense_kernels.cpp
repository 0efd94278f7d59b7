#include "convex/dense/dense_kernels.hpp"

#include <cmath>

#include "convex/dense/pack_kernels.hpp"
#include "convex/processor.hpp"

namespace convex::inline dense {

// Each step waits for the one before: put into vectors, as the compiler would, it waits for their entries
// too.
[[gnu::optimize("no-tree-slp-vectorize"), gnu::noinline]] void factor_block(Index width, double* C) {
#pragma GCC unroll 8
  for (int c = 0; c < 8; ++c) {
    if (c >= width) break;
    const double pivot = C[9 * c], inverse = 1 / pivot, root = std::sqrt(std::max(pivot, 0.0)), r = 1 / root;
    double part[8];
#pragma GCC unroll 8
    for (int i = c + 1; i < 8; ++i) part[i] = C[8 * c + i] * inverse;
#pragma GCC unroll 8
    for (int d = c + 1; d < 8; ++d)
#pragma GCC unroll 8
      for (int i = d; i < 8; ++i) C[8 * d + i] -= C[8 * c + i] * part[d];
    C[9 * c] = root;
#pragma GCC unroll 8
    for (int i = c + 1; i < 8; ++i) C[8 * c + i] *= r;
  }
}

namespace {

/// One table of kernels: functions for one processor family, with their target attribute if any.
#define MOREAU_TABLE(name, target, W, fused)                                                                \
  struct name {                                                                                             \
    using K = Kernels<W, fused>;                                                                            \
    target static void factor(Index n, Index ld, double* T, double* r) { K::factor(n, ld, T, r); }          \
    target static void invert_blocks(Index n, Index ld, const double* T, double* r) {                       \
      K::invert_blocks(n, ld, T, r);                                                                        \
    }                                                                                                       \
    target static void forward(Index n, Index ld, const double* T, const double* r, double* x) {            \
      K::forward(n, ld, T, r, x);                                                                           \
    }                                                                                                       \
    target static void backward(Index n, Index ld, const double* T, const double* r, double* x) {           \
      K::backward(n, ld, T, r, x);                                                                          \
    }                                                                                                       \
    target static void forward_pack(Index n, Index ld, const double* T, const double* r, double* X) {       \
      K::forward_pack(n, ld, T, r, X);                                                                      \
    }                                                                                                       \
    target static void backward_pack(Index n, Index ld, const double* T, const double* r, double* X) {      \
      K::backward_pack(n, ld, T, r, X);                                                                     \
    }                                                                                                       \
    target static void gram(Index n, const double* X, const double* Y, double* G, Index stride) {           \
      K::gram(n, X, Y, G, stride);                                                                          \
    }                                                                                                       \
    target static void dots(Index n, const double* X, const double* y, double* d) { K::dots(n, X, y, d); }  \
    target static void combine(Index n, Index count, const double* X, const double* y, double* w) {         \
      K::combine(n, count, X, y, w);                                                                        \
    }                                                                                                       \
    target static void add_multiple(Index n, double c, const double* x, double* y) {                        \
      K::add_multiple(n, c, x, y);                                                                          \
    }                                                                                                       \
    target static double dot(Index n, const double* x, const double* y) { return K::dot(n, x, y); }         \
    target static void slacks(Index m, Index n, const double* U, const double* x, const double* s,          \
                              double* d) {                                                                  \
      K::slacks(m, n, U, x, s, d);                                                                          \
    }                                                                                                       \
    target static void squares(Index m, Index n, const double* U, const double* x, double* d) {             \
      K::squares(m, n, U, x, d);                                                                            \
    }                                                                                                       \
    target static void stationarity(Index n, const double* A, const double* q, Index m, const double* U,    \
                                    Index count, const Index* rows, const double* lambda, const double* z,  \
                                    double* r) {                                                            \
      K::stationarity(n, A, q, m, U, count, rows, lambda, z, r);                                            \
    }                                                                                                       \
    target static void residual(Index n, const double* A, const double* q, Index m, const double* U,        \
                                Index count, const Index* rows, const double* lambda, const double* z,      \
                                double* r) {                                                                \
      K::residual(n, A, q, m, U, count, rows, lambda, z, r);                                                \
    }                                                                                                       \
    target static void precise_slacks(Index n, const double* X, const double* q, const double* s,           \
                                      double* d) {                                                          \
      K::precise_slacks(n, X, q, s, d);                                                                     \
    }                                                                                                       \
    target static void add_columns(Index n, Index count, const Index* columns, const double* c,             \
                                   const double* X, Index stride, double* y) {                              \
      K::add_columns(n, count, columns, c, X, stride, y);                                                   \
    }                                                                                                       \
    target static void combine_runs(Index n, Index width, const double* D, const double* u, double* into) { \
      K::combine_runs(n, width, D, u, into);                                                                \
    }                                                                                                       \
    target static bool cancels(Index n, const double* U, Index p, double whole, Index count,                \
                               const Index* rows, const double* c) {                                        \
      return K::cancels(n, U, p, whole, count, rows, c);                                                    \
    }                                                                                                       \
    target static double largest_size(Index n, const double* x) { return K::largest_size(n, x); }           \
    target static bool is_on_grid(Index n, const double* x, double shift) {                                 \
      return K::is_on_grid(n, x, shift);                                                                    \
    }                                                                                                       \
    target static bool is_finite(Index n, const double* x) { return K::is_finite(n, x); }                   \
    target static bool is_symmetric(Index ld, const double* T) { return K::is_symmetric(ld, T); }           \
    static constexpr DenseKernels table{                                                                    \
        factor,  invert_blocks, forward,    backward,       forward_pack, backward_pack,                    \
        gram,    dots,          combine,    add_multiple,   dot,          slacks,                           \
        squares, stationarity,  residual,   precise_slacks, add_columns,  combine_runs,                     \
        cancels, largest_size,  is_on_grid, is_finite,      is_symmetric};                                  \
  };

MOREAU_TABLE(Portable, , 2, false)
#ifdef MOREAU_HAS_FAMILIES
MOREAU_TABLE(Wide, [[gnu::target("avx2,fma")]], 4, true)
MOREAU_TABLE(Widest, [[gnu::target("avx512f")]], 8, true)

const DenseKernels* const tables[] = {&Portable::table, &Wide::table, &Widest::table};
#else
const DenseKernels* const tables[] = {&Portable::table};
#endif

constinit const DenseKernels* chosen = &Portable::table;  // until the choice is made, as the program starts
[[maybe_unused]] const bool made = (chosen = tables[static_cast<std::size_t>(processor())], true);

}  // namespace

const DenseKernels& dense_kernels() { return *chosen; }

std::span<const DenseKernels* const> all_dense_kernels() {
  return {tables, static_cast<std::size_t>(processor()) + 1};
}

}  // namespace convex::inline dense
