#include "convex/nearest_point/sparse/front_kernels.hpp"

#include <array>
#include <cmath>

#include "convex/processor.hpp"

namespace convex::inline sparse {
namespace {

/// Columns eliminated at once.
constexpr Index block = 4;

/// Eight numbers anywhere, whatever the registers of the machine.
using Eight [[gnu::vector_size(64), gnu::aligned(8), gnu::may_alias]] = double;
[[gnu::always_inline]] inline const Eight& eight(const double* x) {
  return *reinterpret_cast<const Eight*>(x);
}
[[gnu::always_inline]] inline Eight& eight(double* x) { return *reinterpret_cast<Eight*>(x); }
[[gnu::always_inline]] inline double total(const Eight& x) {
  return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

/// c_i -= Σ_k a_k w_k for two columns c at once, four columns a.
MOREAU_CLONES
void subtract_four_from_two(Index n, double* __restrict c0, double* __restrict c1, const double* a0,
                            const double* a1, const double* a2, const double* a3, const double* w0,
                            const double* w1) {
  const double p0 = w0[0], p1 = w0[1], p2 = w0[2], p3 = w0[3], r0 = w1[0], r1 = w1[1], r2 = w1[2], r3 = w1[3];
  for (Index i = 0; i < n; ++i) {
    const double x0 = a0[i], x1 = a1[i], x2 = a2[i], x3 = a3[i];
    c0[i] -= (x0 * p0 + x1 * p1) + (x2 * p2 + x3 * p3);
    c1[i] -= (x0 * r0 + x1 * r1) + (x2 * r2 + x3 * r3);
  }
}

/// The same for four columns c, where there are registers for sixteen weights; w_k of column j is w[4 j + k].
MOREAU_CLONES
void subtract_four_from_four(Index n, double* __restrict c0, double* __restrict c1, double* __restrict c2,
                             double* __restrict c3, const double* a0, const double* a1, const double* a2,
                             const double* a3, const double* w) {
  const double p0 = w[0], p1 = w[1], p2 = w[2], p3 = w[3], r0 = w[4], r1 = w[5], r2 = w[6], r3 = w[7];
  const double s0 = w[8], s1 = w[9], s2 = w[10], s3 = w[11], t0 = w[12], t1 = w[13], t2 = w[14], t3 = w[15];
  for (Index i = 0; i < n; ++i) {
    const double x0 = a0[i], x1 = a1[i], x2 = a2[i], x3 = a3[i];
    c0[i] -= (x0 * p0 + x1 * p1) + (x2 * p2 + x3 * p3);
    c1[i] -= (x0 * r0 + x1 * r1) + (x2 * r2 + x3 * r3);
    c2[i] -= (x0 * s0 + x1 * s1) + (x2 * s2 + x3 * s3);
    c3[i] -= (x0 * t0 + x1 * t1) + (x2 * t2 + x3 * t3);
  }
}

/// The same with two columns a.
MOREAU_CLONES
void subtract_two_from_four(Index n, double* __restrict c0, double* __restrict c1, double* __restrict c2,
                            double* __restrict c3, const double* a0, const double* a1, const double* w) {
  const double p0 = w[0], p1 = w[1], r0 = w[4], r1 = w[5], s0 = w[8], s1 = w[9], t0 = w[12], t1 = w[13];
  for (Index i = 0; i < n; ++i) {
    const double x0 = a0[i], x1 = a1[i];
    c0[i] -= x0 * p0 + x1 * p1;
    c1[i] -= x0 * r0 + x1 * r1;
    c2[i] -= x0 * s0 + x1 * s1;
    c3[i] -= x0 * t0 + x1 * t1;
  }
}

const bool has_many_registers = processor() == Processor::avx512;

MOREAU_CLONES
void subtract_one(Index n, double* __restrict c, const double* a, double w) {
  for (Index i = 0; i < n; ++i) c[i] -= a[i] * w;
}

/// Columns first … first + count - 1 of L, times their pivots, at row i.
void scaled_row(const double* panel, Index rows, Index first, Index count, Index i, double* w) {
  for (Index k = 0; k < count; ++k) {
    const double* column = panel + (first + k) * rows;
    w[k] = column[i] * column[first + k];
  }
}

/// Takes `count` factored columns off columns c = from … to - 1 of a lower triangle whose column c begins, at
/// its diagonal, at target(c) and belongs to row offset + c of the panel.
template <class Target>
void subtract_columns(const double* panel, Index rows, Index first, Index count, Index from, Index to,
                      Index offset, Target target) {
  std::array<double, block> w0{}, w1{};
  std::array<double, 4 * block> w{};
  Index c = from;
  for (; c + 4 <= to && (has_many_registers || count < block); c += 4) {
    const Index i = offset + c, n = rows - i;
    const double* a = panel + first * rows + i;
    double *c0 = target(c), *c1 = target(c + 1), *c2 = target(c + 2), *c3 = target(c + 3);
    for (Index j = 0; j < 4; ++j) scaled_row(panel, rows, first, count, i + j, w.data() + 4 * j);
    // Columns that are not there weigh nothing.
    const Index second = count > 1 ? rows : 0, third = count > 2 ? 2 * rows : 0,
                last = count > 3 ? 3 * rows : 0;
    // The corner above the rows that all four have.
    const auto entry = [&](Index row, Index j) {
      const double *v = w.data() + 4 * j, *x = a + row;
      return (x[0] * v[0] + x[second] * v[1]) + (x[third] * v[2] + x[last] * v[3]);
    };
    for (Index row = 0; row < 3; ++row) {
      c0[row] -= entry(row, 0);
      if (row >= 1) c1[row - 1] -= entry(row, 1);
      if (row >= 2) c2[row - 2] -= entry(row, 2);
    }
    if (count > 2)
      subtract_four_from_four(n - 3, c0 + 3, c1 + 2, c2 + 1, c3, a + 3, a + second + 3, a + third + 3,
                              a + last + 3, w.data());
    else
      subtract_two_from_four(n - 3, c0 + 3, c1 + 2, c2 + 1, c3, a + 3, a + second + 3, w.data());
  }
  for (; c < to; c += 2) {
    const Index i = offset + c, n = rows - i;
    scaled_row(panel, rows, first, count, i, w0.data());
    const bool pair = c + 1 < to;
    if (pair) scaled_row(panel, rows, first, count, i + 1, w1.data());
    const double* a = panel + first * rows + i;
    double *c0 = target(c), *c1 = pair ? target(c + 1) : nullptr;
    if (count == block && pair) {
      c0[0] -= (a[0] * w0[0] + a[rows] * w0[1]) + (a[2 * rows] * w0[2] + a[3 * rows] * w0[3]);
      subtract_four_from_two(n - 1, c0 + 1, c1, a + 1, a + rows + 1, a + 2 * rows + 1, a + 3 * rows + 1,
                             w0.data(), w1.data());
    } else {
      for (Index k = 0; k < count; ++k) {
        subtract_one(n, c0, a + k * rows, w0[static_cast<std::size_t>(k)]);
        if (pair) subtract_one(n - 1, c1, a + k * rows + 1, w1[static_cast<std::size_t>(k)]);
      }
    }
  }
}

}  // namespace

bool factor_panel(double* panel, Index rows, Index columns) {
  for (Index first = 0; first < columns; first += block) {
    const Index count = std::min(block, columns - first);
    for (Index k = first; k < first + count; ++k) {
      double* column = panel + k * rows;
      for (Index j = first; j < k; ++j) {
        const double* done = panel + j * rows;
        subtract_one(rows - k, column + k, done + k, done[k] * done[j]);
      }
      const double pivot = column[k];
      if (!std::isfinite(pivot) || !(std::abs(pivot) > 0)) return false;
      const double inverse = 1 / pivot;
      for (Index i = k + 1; i < rows; ++i) column[i] *= inverse;
    }
    subtract_columns(panel, rows, first, count, first + count, columns, 0,
                     [&](Index c) { return panel + c * rows + c; });
  }
  return true;
}

void subtract_outer(double* C, Index size, const double* panel, Index rows, Index columns) {
  for (Index first = 0; first < columns; first += block)
    subtract_columns(panel, rows, first, std::min(block, columns - first), 0, size, rows - size,
                     [&](Index c) { return C + c * size + c; });
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

}  // namespace convex::inline sparse
