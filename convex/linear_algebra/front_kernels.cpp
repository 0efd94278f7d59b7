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

  /// What lies before `end` is written, and nothing else.
  MOREAU_INLINE void store_before(double* x, double* end, const Pack& pack) {
    if (end - x >= 8) return P::store(x, pack);
    if constexpr (W == 8) {
      asm("vmovupd %1, %0%{%2%}"
          : "+m"(*reinterpret_cast<double(*)[8]>(x))
          : "v"(pack.part[0]), "Yk"(static_cast<unsigned short>((1U << (end - x)) - 1)));
    } else {
      double all[8];
      P::store(all, pack);
      for (Index r = 0; r < end - x; ++r) x[r] = all[r];
    }
  }

  /// Rows i … i + 8 packs - 1 of columns j … j + columns - 1, of which those exist that the triangle has.
  /// What stands above its diagonal is nobody's.
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
    const bool is_whole = i + 8 * packs <= of.end && j + columns <= of.to;
#pragma GCC unroll 8
    for (Index c = 0; c < columns; ++c) {
      double* const to = of.C + (j + c) * of.stride + i;
#pragma GCC unroll 2
      for (Index p = 0; p < packs; ++p) {
        if (is_whole) {
          P::store(to + 8 * p, P::minus(is_new ? Pack{} : P::load(to + 8 * p), sum[c][p]));
          continue;
        }
        if (j + c >= of.to || of.end <= i + 8 * p) break;
        double* const end = of.C + (j + c) * of.stride + of.end;
        store_before(to + 8 * p, end, P::minus(is_new ? Pack{} : P::load_before(to + 8 * p, end), sum[c][p]));
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
      if (i < n)
        store_before(sum + i, sum + n,
                     P::plus(P::load_before(sum + i, sum + n), P::load_before(given + i, given + n)));
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

  /// Up to `block` columns from `first` on, from which those before have been taken, one after the other.
  MOREAU_INLINE bool eliminate(double* panel, Index rows, Index first, Index count) {
    double* const column = panel + first * rows;
    double inverse[block], weight[block][block];  // 1/D_k; D_j times what L has of column j in row k
    for (Index k = 0; k < count; ++k) {
      double* const own = column + k * rows + first;
      for (Index i = k; i < count; ++i)
        for (Index j = 0; j < k; ++j) own[i] -= column[j * rows + first + i] * weight[j][k];
      const double pivot = own[k];
      if (!std::isfinite(pivot) || !(std::abs(pivot) > 0)) return false;
      inverse[k] = 1 / pivot;
      for (Index i = k + 1; i < count; ++i) {
        weight[k][i] = own[i];
        own[i] *= inverse[k];
      }
    }
    for (Index i = first + count; i < rows; i += 8)
      if (count == block)
        eliminate_rows<block>(column + i, rows, std::min(Index{8}, rows - i), inverse, weight, block);
      else
        eliminate_rows<block - 1>(column + i, rows, std::min(Index{8}, rows - i), inverse, weight, count);
    return true;
  }

  /// The same of eight rows below, or fewer.
  template <Index most>
  MOREAU_INLINE void eliminate_rows(double* x, Index stride, Index some, const double* inverse,
                                    const double (&weight)[block][block], Index count) {
    Pack L[most];
#pragma GCC unroll 4
    for (Index k = 0; k < most; ++k) {
      if (k >= count) break;
      L[k] = P::load(x + k * stride);
#pragma GCC unroll 4
      for (Index j = 0; j < k; ++j) P::subtract_product(L[k], L[j], weight[j][k]);
      L[k] = P::times(L[k], inverse[k]);
      store_before(x + k * stride, x + k * stride + some, L[k]);
    }
  }

  MOREAU_INLINE void forward(const double* panel, Index rows, Index columns, double* x) {
    Index j = 0;
    for (; j + block <= columns; j += block) {
      const double *a = panel + j * rows, *b = a + rows, *c = b + rows, *d = c + rows;
      const double x0 = x[j], x1 = x[j + 1] -= a[j + 1] * x0, x2 = x[j + 2] -= a[j + 2] * x0 + b[j + 2] * x1,
                   x3 = x[j + 3] -= (a[j + 3] * x0 + b[j + 3] * x1) + c[j + 3] * x2;
      for (Index i = j + block; i < rows; i += 8) {
        Pack y = P::load(x + i), z = P::times(P::load(b + i), x1);
        P::subtract_product(y, P::load(a + i), x0);
        P::add_product(z, P::load(d + i), x3);
        P::subtract_product(y, P::load(c + i), x2);
        P::store(x + i, P::minus(y, z));
      }
    }
    for (; j < columns; ++j) {
      const double *a = panel + j * rows, x0 = x[j];
      for (Index i = j + 1; i < rows; i += 8) {
        Pack y = P::load(x + i);
        P::subtract_product(y, P::load(a + i), x0);
        P::store(x + i, y);
      }
    }
  }

  MOREAU_INLINE void backward(const double* panel, Index rows, Index columns, double* x) {
    Index end = columns;
    for (; end % block != 0; --end) {
      const double* a = panel + (end - 1) * rows;
      Pack sum{};
      for (Index i = end; i < rows; i += 8) P::add_products(sum, P::load(a + i), P::load(x + i));
      x[end - 1] = x[end - 1] / a[end - 1] - P::total(sum);
    }
    for (; end > 0; end -= block) {
      const Index j = end - block;
      const double *a = panel + j * rows, *b = a + rows, *c = b + rows, *d = c + rows;
      Pack sum[8];
      P::clear(sum);
      for (Index i = end; i < rows; i += 8) {
        const Pack y = P::load(x + i);
        P::add_products(sum[0], P::load(a + i), y);
        P::add_products(sum[1], P::load(b + i), y);
        P::add_products(sum[2], P::load(c + i), y);
        P::add_products(sum[3], P::load(d + i), y);
      }
      double total[8];
      P::store(total, P::totals(sum));
      const double x3 = x[j + 3] = x[j + 3] / d[j + 3] - total[3],
                   x2 = x[j + 2] = x[j + 2] / c[j + 2] - total[2] - c[j + 3] * x3,
                   x1 = x[j + 1] = x[j + 1] / b[j + 1] - total[1] - (b[j + 2] * x2 + b[j + 3] * x3);
      x[j] = x[j] / a[j] - total[0] - (a[j + 1] * x1 + (a[j + 2] * x2 + a[j + 3] * x3));
    }
  }
};

// Products and sums may be fused, as in the dense kernels.
#pragma GCC push_options
#pragma GCC optimize("fp-contract=fast")
struct FrontKernels {
  void (*subtract)(const Products&);
  bool (*eliminate)(double* panel, Index rows, Index first, Index count);
  void (*add_columns)(const double*, Index, Index, Index, const int*, double*, Index);
  void (*forward)(const double* panel, Index rows, Index columns, double* x);
  void (*backward)(const double* panel, Index rows, Index columns, double* x);
};

template <int W>
struct Family;
#define MOREAU_FRONT_KERNELS(W, target)                                                                      \
  template <>                                                                                                \
  struct Family<W> {                                                                                         \
    target static void subtract(const Products& of) { Tiles<W>::subtract(of); }                              \
    target static bool eliminate(double* panel, Index rows, Index first, Index count) {                      \
      return Tiles<W>::eliminate(panel, rows, first, count);                                                 \
    }                                                                                                        \
    target static void add_columns(const double* update, Index size, Index from, Index to, const int* place, \
                                   double* into, Index stride) {                                             \
      Tiles<W>::add_columns(update, size, from, to, place, into, stride);                                    \
    }                                                                                                        \
    target static void forward(const double* panel, Index rows, Index columns, double* x) {                  \
      Tiles<W>::forward(panel, rows, columns, x);                                                            \
    }                                                                                                        \
    target static void backward(const double* panel, Index rows, Index columns, double* x) {                 \
      Tiles<W>::backward(panel, rows, columns, x);                                                           \
    }                                                                                                        \
    static constexpr FrontKernels table{subtract, eliminate, add_columns, forward, backward};                \
  };
MOREAU_FRONT_KERNELS(2, )
#ifdef MOREAU_HAS_FAMILIES
MOREAU_FRONT_KERNELS(4, [[gnu::target("avx2,fma")]])
MOREAU_FRONT_KERNELS(8, [[gnu::target("avx512f")]])
#endif
#undef MOREAU_FRONT_KERNELS
#pragma GCC pop_options

const FrontKernels& kernels() {
  static constexpr const FrontKernels* tables[] = {&Family<2>::table,
#ifdef MOREAU_HAS_FAMILIES
                                                   &Family<4>::table, &Family<8>::table
#endif
  };
  static const FrontKernels& chosen = *tables[static_cast<std::size_t>(processor())];
  return chosen;
}

/// Columns first … first + count - 1, from which those before have been taken: the first half of them, then
/// the others without it.
bool factor_columns(double* panel, Index rows, Index first, Index count) {
  if (count <= block) return kernels().eliminate(panel, rows, first, count);
  const Index half = (count / 2 + block - 1) / block * block, middle = first + half;
  if (!factor_columns(panel, rows, first, half)) return false;
  const double* L = panel + first * rows;
  kernels().subtract({panel, rows, middle, first + count, rows, L, L + first, rows, half});
  return factor_columns(panel, rows, middle, count - half);
}

}  // namespace

bool factor_panel(double* panel, Index rows, Index columns) {
  return factor_columns(panel, rows, 0, columns);
}

void outer_product(double* C, Index size, const double* panel, Index rows, Index columns) {
  kernels().subtract({C, size, 0, size, size, panel + rows - size, panel, rows, columns, true});
}

void add_columns(const double* update, Index size, Index from, Index to, const int* place, double* target,
                 Index stride) {
  kernels().add_columns(update, size, from, to, place, target, stride);
}

void forward_panel(const double* panel, Index rows, Index columns, double* x) {
  kernels().forward(panel, rows, columns, x);
}

void backward_panel(const double* panel, Index rows, Index columns, double* x) {
  kernels().backward(panel, rows, columns, x);
}

}  // namespace convex::linear_algebra
