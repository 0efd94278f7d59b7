#include "convex/dense_kernels.hpp"

#include <cmath>

#include "convex/triangle_kernels.hpp"

namespace convex {

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

template <int W, bool Fused>
struct Kernels : TriangleKernels<W, Fused> {
  using P = Packs<W, Fused>;
  using Pack = typename P::Pack;

  MOREAU_INLINE void gram(Index n, const double* X, const double* Y, double* into, Index stride) {
    constexpr Index together = W == 8 ? 8 : 4;
    for (Index first = 0; first < 8; first += together) {
      Pack sum[together] = {};
      for (Index i = 0; i < n; ++i) {
        const Pack x = P::load(X + 8 * i);
        for (Index l = 0; l < together; ++l) P::add_product(sum[l], x, Y[8 * i + first + l]);
      }
      for (Index l = 0; l < together; ++l) P::store(into + (first + l) * stride, sum[l]);
    }
  }

  MOREAU_INLINE void dots(Index n, const double* X, const double* y, double* into) {
    Pack even{}, odd{};
    Index i = 0;
    for (; i + 2 <= n; i += 2) {
      P::add_product(even, P::load(X + 8 * i), y[i]);
      P::add_product(odd, P::load(X + 8 * i + 8), y[i + 1]);
    }
    if (i < n) P::add_product(even, P::load(X + 8 * i), y[i]);
    P::store(into, P::plus(even, odd));
  }

  MOREAU_INLINE void combine(Index n, Index count, const double* X, const double* y, double* w) {
    for (Index i = 0; i < n; ++i) {
      Pack sum{};
      for (Index k = 0; k < count; ++k)
        P::add_products(sum, P::load(X + 8 * (k * n + i)), P::load(y + 8 * k));
      w[i] += P::total(sum);
    }
  }

  MOREAU_INLINE void add_multiple(Index n, double c, const double* x, double* y) {
    for (Index i = 0; i < n; i += 8) {
      Pack sum = P::load(y + i);
      P::add_product(sum, P::load(x + i), c);
      P::store(y + i, sum);
    }
  }

  MOREAU_INLINE double dot(Index n, const double* x, const double* y) {
    Pack sum{};
    for (Index i = 0; i < n; i += 8) P::add_products(sum, P::load(x + i), P::load(y + i));
    return P::total(sum);
  }

  /// Σ of products of packs along `count` rows of U, from which nothing may be read beyond `end`; factors are
  /// 0 where rows have ended.
  template <int count, class Factor>
  MOREAU_INLINE void along(Index n, const double* U, const double* end, Factor factor, double* into) {
    Pack sum[count] = {};
    Index i = 0;
    for (; i + 8 <= n; i += 8)
      for (int r = 0; r < count; ++r) {
        const Pack u = P::load(U + r * n + i);
        P::add_products(sum[r], factor(i, u), u);
      }
    if (i < n)
      for (int r = 0; r < count; ++r) {
        const Pack u = P::load_before(U + r * n + i, end);
        P::add_products(sum[r], factor(i, u), u);
      }
    for (int r = 0; r < count; ++r) into[r] = P::total(sum[r]);
  }

  MOREAU_INLINE void slacks(Index m, Index n, const double* U, const double* x, const double* s,
                            double* into) {
    const double* const end = U + m * n;
    const auto factor = [x](Index i, const Pack&) __attribute__((always_inline)) { return P::load(x + i); };
    Index a = 0;
    for (; a + 4 <= m; a += 4, U += 4 * n) along<4>(n, U, end, factor, into + a);
    for (; a < m; ++a, U += n) along<1>(n, U, end, factor, into + a);
    for (a = 0; a < m; ++a) into[a] -= s[a];
  }

  MOREAU_INLINE void squares(Index m, Index n, const double* U, const double* weight, double* into) {
    const double* const end = U + m * n;
    const auto factor = [weight](Index i, const Pack& u) __attribute__((always_inline)) {
      return P::times(u, P::load(weight + i));
    };
    Index a = 0;
    for (; a + 4 <= m; a += 4, U += 4 * n) along<4>(n, U, end, factor, into + a);
    for (; a < m; ++a, U += n) along<1>(n, U, end, factor, into + a);
  }

  MOREAU_INLINE void stationarity(Index n, const double* A, const double* q, Index m, const double* U,
                                  Index count, const Index* rows, const double* lambda, const double* z,
                                  double* into) {
    Index i = 0;
    for (; i + 8 <= n; i += 8) {
      Pack hi = P::load(z + i), lo{};
      for (Index k = 0; k < count; ++k) P::add_precisely(hi, lo, P::load(U + rows[k] * n + i), lambda[k]);
      for (Index j = 0; j < n; ++j) P::add_precisely(hi, lo, P::load(A + j * n + i), -q[j]);
      P::store(into + i, P::plus(hi, lo));
    }
    if (i == n) return;
    const double *const end_of_A = A + n * n, *const end_of_U = U + m * n;
    Pack hi = P::load(z + i), lo{};
    for (Index k = 0; k < count; ++k)
      P::add_precisely(hi, lo, P::load_before(U + rows[k] * n + i, end_of_U), lambda[k]);
    for (Index j = 0; j < n; ++j) P::add_precisely(hi, lo, P::load_before(A + j * n + i, end_of_A), -q[j]);
    P::store(into + i, P::plus(hi, lo));
    for (i = n; i < padded(n); ++i) into[i] = 0;
  }

  MOREAU_INLINE void precise_slacks(Index n, const double* X, const double* q, const double* s,
                                    double* into) {
    Pack hi = P::times(P::load(s), -1), lo{};
    for (Index i = 0; i < n; ++i) P::add_precisely(hi, lo, P::load(X + 8 * i), q[i]);
    P::store(into, P::plus(hi, lo));
  }
};

/// One table of kernels: functions for one processor family, with their target attribute if any.
#define MOREAU_TABLE(name, target, W, fused)                                                               \
  struct name {                                                                                            \
    using K = Kernels<W, fused>;                                                                           \
    target static void factor(Index n, Index ld, double* T, double* r) { K::factor(n, ld, T, r); }         \
    target static void invert_blocks(Index n, Index ld, const double* T, double* r) {                      \
      K::invert_blocks(n, ld, T, r);                                                                       \
    }                                                                                                      \
    target static void forward(Index n, Index ld, const double* T, const double* r, double* x) {           \
      K::forward(n, ld, T, r, x);                                                                          \
    }                                                                                                      \
    target static void backward(Index n, Index ld, const double* T, const double* r, double* x) {          \
      K::backward(n, ld, T, r, x);                                                                         \
    }                                                                                                      \
    target static void forward_pack(Index n, Index ld, const double* T, const double* r, double* X) {      \
      K::forward_pack(n, ld, T, r, X);                                                                     \
    }                                                                                                      \
    target static void gram(Index n, const double* X, const double* Y, double* G, Index stride) {          \
      K::gram(n, X, Y, G, stride);                                                                         \
    }                                                                                                      \
    target static void dots(Index n, const double* X, const double* y, double* d) { K::dots(n, X, y, d); } \
    target static void combine(Index n, Index count, const double* X, const double* y, double* w) {        \
      K::combine(n, count, X, y, w);                                                                       \
    }                                                                                                      \
    target static void add_multiple(Index n, double c, const double* x, double* y) {                       \
      K::add_multiple(n, c, x, y);                                                                         \
    }                                                                                                      \
    target static double dot(Index n, const double* x, const double* y) { return K::dot(n, x, y); }        \
    target static void slacks(Index m, Index n, const double* U, const double* x, const double* s,         \
                              double* d) {                                                                 \
      K::slacks(m, n, U, x, s, d);                                                                         \
    }                                                                                                      \
    target static void squares(Index m, Index n, const double* U, const double* x, double* d) {            \
      K::squares(m, n, U, x, d);                                                                           \
    }                                                                                                      \
    target static void stationarity(Index n, const double* A, const double* q, Index m, const double* U,   \
                                    Index count, const Index* rows, const double* lambda, const double* z, \
                                    double* r) {                                                           \
      K::stationarity(n, A, q, m, U, count, rows, lambda, z, r);                                           \
    }                                                                                                      \
    target static void precise_slacks(Index n, const double* X, const double* q, const double* s,          \
                                      double* d) {                                                         \
      K::precise_slacks(n, X, q, s, d);                                                                    \
    }                                                                                                      \
    static constexpr DenseKernels table{factor, invert_blocks, forward,      backward,      forward_pack,  \
                                        gram,   dots,          combine,      add_multiple,  dot,           \
                                        slacks, squares,       stationarity, precise_slacks};              \
  };

MOREAU_TABLE(Portable, , 2, false)
#if defined(__x86_64__) && defined(__GNUC__)
MOREAU_TABLE(Wide, [[gnu::target("avx2,fma")]], 4, true)
MOREAU_TABLE(Widest, [[gnu::target("avx512f")]], 8, true)

const DenseKernels* const tables[] = {&Portable::table, &Wide::table, &Widest::table};

std::size_t usable() {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return 1;
  return __builtin_cpu_supports("avx512f") ? 3 : 2;
}
#else
const DenseKernels* const tables[] = {&Portable::table};
std::size_t usable() { return 1; }
#endif

constinit const DenseKernels* chosen = &Portable::table;  // until the choice is made, as the program starts
[[maybe_unused]] const bool made = (chosen = tables[usable() - 1], true);

}  // namespace

const DenseKernels& dense_kernels() { return *chosen; }

std::span<const DenseKernels* const> all_dense_kernels() { return {tables, usable()}; }

}  // namespace convex
