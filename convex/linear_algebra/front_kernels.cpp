#include "convex/linear_algebra/front_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "convex/dense/packs.hpp"
#include "convex/processor.hpp"

namespace convex::linear_algebra {
namespace {

/// Columns eliminated one by one before they are taken off the others, and columns that a vector takes at
/// once.
constexpr Index block = 4;

/// Products are summed over so many columns at a time: their weights stay in the cache nearest to the
/// processor.
constexpr Index most_summed = 128;

/// Eight numbers anywhere, whatever the registers of the machine.
using Eight [[gnu::vector_size(64), gnu::aligned(8), gnu::may_alias]] = double;
[[gnu::always_inline]] inline const Eight& eight(const double* x) {
  return *reinterpret_cast<const Eight*>(x);
}
[[gnu::always_inline]] inline Eight& eight(double* x) { return *reinterpret_cast<Eight*>(x); }
[[gnu::always_inline]] inline double total(const Eight& x) {
  return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

/// L D Lᵀ of some factored columns, to be taken off columns from … to - 1 of a lower triangle: its entry
/// (i, j) is C[j stride + i], that of column k of L is L[k rows + i], and its pivot D[k (rows + 1)].
struct Products {
  double* C;
  Index stride, from, to, end;  ///< rows before `end`
  const double* L;
  const double* D;
  Index rows, count;
  bool is_new = false;  ///< what C holds is not to be read
};

template <int W>
struct Tiles {
  using P = dense::Packs<W, true>;
  using Pack = typename P::Pack;
  /// What is summed in registers at a time: so many packs of eight rows of so many columns.
  static constexpr Index packs_at_once = W == 8 ? 2 : 1, columns_at_once = W;

  /// Of eight numbers those of a mask; the others are neither read nor written.
  MOREAU_INLINE Pack read(const double* x, unsigned mask) {
    Pack pack;
    asm("vmovupd %2, %0%{%1%}%{z%}"
        : "=v"(pack.part[0])
        : "Yk"(static_cast<unsigned short>(mask)), "m"(*reinterpret_cast<const double(*)[8]>(x)));
    return pack;
  }
  MOREAU_INLINE void write(double* x, unsigned mask, const Pack& pack) {
    asm("vmovupd %1, %0%{%2%}"
        : "+m"(*reinterpret_cast<double(*)[8]>(x))
        : "v"(pack.part[0]), "Yk"(static_cast<unsigned short>(mask)));
  }

  /// Rows i … i + 8 packs - 1 of columns j … j + columns - 1, of which those exist that the triangle has.
  template <Index packs, Index columns>
  MOREAU_INLINE void subtract_tile(const Products& of, Index i, Index j, const double* L, Index count,
                                   const double* weight, bool is_new) {
    Pack sum[columns][packs];
#pragma GCC unroll 8
    for (Index c = 0; c < columns; ++c) P::clear(sum[c]);
    for (Index k = 0; k < count; ++k, L += of.rows, weight += columns_at_once) {
      Pack x[packs];
#pragma GCC unroll 2
      for (Index p = 0; p < packs; ++p) x[p] = P::load(L + i + 8 * p);
#pragma GCC unroll 8
      for (Index c = 0; c < columns; ++c)
#pragma GCC unroll 2
        for (Index p = 0; p < packs; ++p) P::add_product(sum[c][p], x[p], weight[c]);
    }
    const bool is_whole = i >= j + columns - 1 && i + 8 * packs <= of.end && j + columns <= of.to;
#pragma GCC unroll 8
    for (Index c = 0; c < columns; ++c) {
      double* const to = of.C + (j + c) * of.stride + i;
#pragma GCC unroll 2
      for (Index p = 0; p < packs; ++p) {
        if (is_whole) {
          P::store(to + 8 * p, P::minus(is_new ? Pack{} : P::load(to + 8 * p), sum[c][p]));
          continue;
        }
        if (j + c >= of.to) break;
        const Index first = std::max(Index{0}, j + c - i - 8 * p),
                    last = std::min(Index{8}, of.end - i - 8 * p);
        if (first >= last) continue;
        if constexpr (W == 8) {
          const unsigned rows = (1U << last) - (1U << first);
          write(to + 8 * p, rows, P::minus(is_new ? Pack{} : read(to + 8 * p, rows), sum[c][p]));
          continue;
        }
        double part[8];
        P::store(part, sum[c][p]);
        for (Index r = first; r < last; ++r) to[8 * p + r] = (is_new ? 0 : to[8 * p + r]) - part[r];
      }
    }
  }

  template <Index columns>
  MOREAU_INLINE void subtract_rows(const Products& of, Index j, const double* L, Index count,
                                   const double* weight, bool is_new) {
    Index i = j;
    for (; i + 8 < of.end; i += 8 * packs_at_once)
      subtract_tile<packs_at_once, columns>(of, i, j, L, count, weight, is_new);
    if (i < of.end) subtract_tile<1, columns>(of, i, j, L, count, weight, is_new);
  }

  MOREAU_INLINE void subtract(const Products& of) {
    alignas(64) double weights[most_summed * columns_at_once];
    for (Index first = 0; first < of.count; first += most_summed) {
      const Index count = std::min(most_summed, of.count - first);
      const double* L = of.L + first * of.rows;
      for (Index j = of.from; j < of.to; j += columns_at_once) {
        for (Index k = 0; k < count; ++k) {
          const double pivot = of.D[(first + k) * (of.rows + 1)];
          typename P::Part weight;
          std::memcpy(&weight, L + k * of.rows + j, sizeof weight);
          weight = weight * pivot;
          std::memcpy(weights + k * columns_at_once, &weight, sizeof weight);
        }
        if (of.to - j <= columns_at_once / 2)
          subtract_rows<columns_at_once / 2>(of, j, L, count, weights, of.is_new && first == 0);
        else
          subtract_rows<columns_at_once>(of, j, L, count, weights, of.is_new && first == 0);
      }
    }
  }

  MOREAU_INLINE void add(Index n, const double* given, double* sum) {
    Index i = 0;
    for (; i + 8 <= n; i += 8) P::store(sum + i, P::plus(P::load(sum + i), P::load(given + i)));
    if constexpr (W == 8) {
      const unsigned rows = (1U << (n - i)) - 1;
      if (i < n) write(sum + i, rows, P::plus(read(sum + i, rows), read(given + i, rows)));
    } else {
      for (; i < n; ++i) sum[i] += given[i];
    }
  }

  /// Rows that follow each other in both are added together: as a rule there are a few such runs.
  MOREAU_INLINE void add_columns(const double* update, Index size, Index from, Index to, const int* place,
                                 double* target, Index stride) {
    for (Index first = from, end = from; first < size; first = end) {
      for (end = first + 1; end < size && place[end] == place[end - 1] + 1;) ++end;
      const Index shift = place[first] - first;
      for (Index j = from; j < std::min(to, end); ++j) {
        const Index top = std::max(first, j);
        add(end - top, update + j * size + top, target + place[j] * stride + shift + top);
      }
    }
  }
};

// Products and sums may be fused, as in the dense kernels.
#pragma GCC push_options
#pragma GCC optimize("fp-contract=fast")
void subtract_by_two(const Products& of) { Tiles<2>::subtract(of); }
#ifdef MOREAU_HAS_FAMILIES
[[gnu::target("avx2,fma")]] void subtract_by_four(const Products& of) { Tiles<4>::subtract(of); }
[[gnu::target("avx512f")]] void subtract_by_eight(const Products& of) { Tiles<8>::subtract(of); }
#endif
#pragma GCC pop_options

using AddColumns = void(const double*, Index, Index, Index, const int*, double*, Index);
constinit AddColumns* const add_tables[] = {&dense::Compiled<2, &Tiles<2>::add_columns>::at,
#ifdef MOREAU_HAS_FAMILIES
                                            &dense::Compiled<4, &Tiles<4>::add_columns>::at,
                                            &dense::Compiled<8, &Tiles<8>::add_columns>::at
#endif
};

void subtract(const Products& of) {
#ifdef MOREAU_HAS_FAMILIES
  static const Processor machine = processor();
  if (machine == Processor::avx512) return subtract_by_eight(of);
  if (machine == Processor::avx2) return subtract_by_four(of);
#endif
  subtract_by_two(of);
}

MOREAU_CLONES
void subtract_one(Index n, double* __restrict c, const double* a, double w) {
  for (Index i = 0; i < n; ++i) c[i] -= a[i] * w;
}

MOREAU_CLONES
void scale(Index n, double* c, double w) {
  for (Index i = 0; i < n; ++i) c[i] *= w;
}

/// Columns first … first + count - 1, from which those before have been taken: the first half of them, then
/// the others without it.
bool factor_columns(double* panel, Index rows, Index first, Index count) {
  if (count > block) {
    const Index half = (count / 2 + block - 1) / block * block, middle = first + half;
    if (!factor_columns(panel, rows, first, half)) return false;
    const double* L = panel + first * rows;
    subtract({panel, rows, middle, first + count, rows, L, L + first, rows, half});
    return factor_columns(panel, rows, middle, count - half);
  }
  for (Index k = first; k < first + count; ++k) {
    double* column = panel + k * rows;
    for (Index j = first; j < k; ++j) {
      const double* done = panel + j * rows;
      subtract_one(rows - k, column + k, done + k, done[k] * done[j]);
    }
    const double pivot = column[k];
    if (!std::isfinite(pivot) || !(std::abs(pivot) > 0)) return false;
    scale(rows - k - 1, column + k + 1, 1 / pivot);
  }
  return true;
}

}  // namespace

bool factor_panel(double* panel, Index rows, Index columns) {
  return factor_columns(panel, rows, 0, columns);
}

void outer_product(double* C, Index size, const double* panel, Index rows, Index columns) {
  subtract({C, size, 0, size, size, panel + rows - size, panel, rows, columns, true});
}

void add_columns(const double* update, Index size, Index from, Index to, const int* place, double* target,
                 Index stride) {
  static AddColumns* const chosen = add_tables[static_cast<std::size_t>(processor())];
  chosen(update, size, from, to, place, target, stride);
}

MOREAU_CLONES
void forward_panel(const double* panel, Index rows, Index columns, double* x) {
  Index j = 0;
  for (; j + block <= columns; j += block) {
    const double *a = panel + j * rows, *b = a + rows, *c = b + rows, *d = c + rows;
    const double x0 = x[j], x1 = x[j + 1] -= a[j + 1] * x0, x2 = x[j + 2] -= a[j + 2] * x0 + b[j + 2] * x1,
                 x3 = x[j + 3] -= (a[j + 3] * x0 + b[j + 3] * x1) + c[j + 3] * x2;
    for (Index i = j + block; i < rows; i += 8)
      eight(x + i) -= (eight(a + i) * x0 + eight(b + i) * x1) + (eight(c + i) * x2 + eight(d + i) * x3);
  }
  for (; j < columns; ++j) {
    const double *a = panel + j * rows, x0 = x[j];
    for (Index i = j + 1; i < rows; i += 8) eight(x + i) -= eight(a + i) * x0;
  }
}

MOREAU_CLONES
void backward_panel(const double* panel, Index rows, Index columns, double* x) {
  Index end = columns;
  for (; end % block != 0; --end) {
    const double* a = panel + (end - 1) * rows;
    Eight sum{};
    for (Index i = end; i < rows; i += 8) sum += eight(a + i) * eight(x + i);
    x[end - 1] = x[end - 1] / a[end - 1] - total(sum);
  }
  for (; end > 0; end -= block) {
    const Index j = end - block;
    const double *a = panel + j * rows, *b = a + rows, *c = b + rows, *d = c + rows;
    Eight s0{}, s1{}, s2{}, s3{};
    for (Index i = end; i < rows; i += 8) {
      const Eight y = eight(x + i);
      s0 += eight(a + i) * y;
      s1 += eight(b + i) * y;
      s2 += eight(c + i) * y;
      s3 += eight(d + i) * y;
    }
    const double x3 = x[j + 3] = x[j + 3] / d[j + 3] - total(s3),
                 x2 = x[j + 2] = x[j + 2] / c[j + 2] - total(s2) - c[j + 3] * x3,
                 x1 = x[j + 1] = x[j + 1] / b[j + 1] - total(s1) - (b[j + 2] * x2 + b[j + 3] * x3);
    x[j] = x[j] / a[j] - total(s0) - (a[j + 1] * x1 + (a[j + 2] * x2 + a[j + 3] * x3));
  }
}

}  // namespace convex::linear_algebra
