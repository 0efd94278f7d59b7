#include "convex/dense/triangular_solve.hpp"

namespace convex::inline dense {
namespace {

/// Beyond this the blocked solver is as fast.
constexpr Index short_size = 96;

/// Forward substitution for so many right-hand sides side by side. The columns of T are read once for all of
/// them.
template <int Sides>
void solve_lower(Index n, const double* T, Index stride, double* X, Index sides_stride) {
  Index j = 0;
  for (; j + 4 <= n; j += 4, T += 4 * stride) {
    const double *a = T, *b = a + stride, *c = b + stride, *d = c + stride;
    double xa[Sides], xb[Sides], xc[Sides], xd[Sides];
    for (int k = 0; k < Sides; ++k) {
      double* x = X + k * sides_stride;
      xa[k] = x[j] /= a[j];
      xb[k] = x[j + 1] = (x[j + 1] - a[j + 1] * xa[k]) / b[j + 1];
      xc[k] = x[j + 2] = (x[j + 2] - a[j + 2] * xa[k] - b[j + 2] * xb[k]) / c[j + 2];
      xd[k] = x[j + 3] = (x[j + 3] - a[j + 3] * xa[k] - b[j + 3] * xb[k] - c[j + 3] * xc[k]) / d[j + 3];
    }
#pragma GCC ivdep
    for (Index i = j + 4; i < n; ++i) {
      const double ai = a[i], bi = b[i], ci = c[i], di = d[i];
#pragma GCC unroll 4
      for (int k = 0; k < Sides; ++k)
        X[k * sides_stride + i] -= (ai * xa[k] + bi * xb[k]) + (ci * xc[k] + di * xd[k]);
    }
  }
  for (; j < n; ++j, T += stride)
    for (int k = 0; k < Sides; ++k) {
      double* x = X + k * sides_stride;
      x[j] /= T[j];
      for (Index i = j + 1; i < n; ++i) x[i] -= T[i] * x[j];
    }
}

}  // namespace

void solve_lower_triangle(Eigen::Ref<const Matrix> T, Eigen::Ref<Matrix> X) {
  const Index n = X.rows();
  if (n > short_size) {
    if (X.cols() == 1) {
      auto x = X.col(0);  // for one the solve with a matrix would pack and block in vain
      T.triangularView<Eigen::Lower>().solveInPlace(x);
    } else if (X.cols() > 0) {
      T.triangularView<Eigen::Lower>().solveInPlace(X);
    }
    return;
  }
  const double* triangle = T.data();
  const Index stride = T.outerStride(), sides_stride = X.outerStride();
  double* x = X.data();
  Index left = X.cols();
  for (; left >= 4; left -= 4, x += 4 * sides_stride) solve_lower<4>(n, triangle, stride, x, sides_stride);
  if (left == 3) solve_lower<3>(n, triangle, stride, x, sides_stride);
  if (left == 2) solve_lower<2>(n, triangle, stride, x, sides_stride);
  if (left == 1) solve_lower<1>(n, triangle, stride, x, sides_stride);
}

void solve_upper_triangle(Eigen::Ref<const Matrix> T, Eigen::Ref<Vector> x) {
  const Index n = x.size(), stride = T.outerStride();
  if (n > short_size) {
    T.triangularView<Eigen::Upper>().solveInPlace(x);
    return;
  }
  double* __restrict to = x.data();
  Index j = n;
  for (; j >= 4; j -= 4) {
    const double *d = T.data() + (j - 1) * stride, *c = d - stride, *b = c - stride, *a = b - stride;
    const double xd = to[j - 1] / d[j - 1];
    const double xc = (to[j - 2] - d[j - 2] * xd) / c[j - 2];
    const double xb = (to[j - 3] - d[j - 3] * xd - c[j - 3] * xc) / b[j - 3];
    const double xa = (to[j - 4] - d[j - 4] * xd - c[j - 4] * xc - b[j - 4] * xb) / a[j - 4];
    to[j - 1] = xd;
    to[j - 2] = xc;
    to[j - 3] = xb;
    to[j - 4] = xa;
    for (Index i = 0; i < j - 4; ++i) to[i] -= (a[i] * xa + b[i] * xb) + (c[i] * xc + d[i] * xd);
  }
  for (; j > 0; --j) {
    const double* column = T.data() + (j - 1) * stride;
    to[j - 1] /= column[j - 1];
    for (Index i = 0; i + 1 < j; ++i) to[i] -= column[i] * to[j - 1];
  }
}

}  // namespace convex::inline dense
