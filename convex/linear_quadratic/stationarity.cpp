#include "convex/linear_quadratic/stationarity.hpp"

#include <algorithm>

namespace convex::linear_quadratic {
namespace {

void add_product(const SparseMatrix& A, const DoubleDoubleVector& x, DoubleDoubleVector& sum) {
  for (Index j = 0; j < A.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(A, j); it; ++it)
      add_multiple(1, &it.value(), x[j], &sum.hi[it.row()], &sum.lo[it.row()]);
}

void subtract_multipliers(const LinearQuadratic& f, const Vector& lambda, DoubleDoubleVector& sum) {
  for (Index a = 0; a < f.rows(); ++a) {
    if (lambda[a] == 0) continue;  // a row that takes no part
    for (SparseRows::InnerIterator it(f.G, a); it; ++it)
      add_multiple(1, &it.value(), {-lambda[a], 0}, &sum.hi[it.col()], &sum.lo[it.col()]);
  }
}

}  // namespace

void add_product(const Metric& A, const DoubleDoubleVector& x, DoubleDoubleVector& sum) {
  const Index n = A.dimension();
  switch (A.kind()) {
    case MetricKind::identity:
    case MetricKind::diagonal:
      for (Index i = 0; i < n; ++i) add_multiple(1, &A.diagonal()[i], x[i], &sum.hi[i], &sum.lo[i]);
      return;
    case MetricKind::dense:
      for (Index j = 0; j < n; ++j)
        add_multiple(n, A.dense_gram().col(j).data(), x[j], sum.hi.data(), sum.lo.data());
      return;
    case MetricKind::sparse:
      add_product(A.sparse_gram(), x, sum);
      return;
  }
}

DoubleDoubleVector slope(const LinearQuadratic& f, const DoubleDoubleVector& xi) {
  DoubleDoubleVector sum(f.c);
  add_product(f.H, xi, sum);
  return sum;
}

DoubleDoubleVector gradient(const LinearQuadratic& f, const Metric& W, const Vector& z,
                            const DoubleDoubleVector& xi) {
  DoubleDoubleVector sum = slope(f, xi), away(f.n);
  for (Index i = 0; i < f.n; ++i) {
    const DoubleDouble d = add(xi[i], {-z[i], 0});
    away.hi[i] = d.hi;
    away.lo[i] = d.lo;
  }
  add_product(W, away, sum);
  return sum;
}

Vector stationarity_defect(const LinearQuadratic& f, const Metric& W, const Vector& z, const Vector& xi,
                           const Vector& lambda) {
  DoubleDoubleVector sum = gradient(f, W, z, DoubleDoubleVector(xi));
  subtract_multipliers(f, lambda, sum);
  return sum.value();
}

Vector subgradient_of_multipliers(const LinearQuadratic& f, const Vector& xi, const Vector& lambda) {
  DoubleDoubleVector sum = slope(f, DoubleDoubleVector(xi));
  subtract_multipliers(f, lambda, sum);
  return sum.value().head(f.n);
}

double complementarity(const LinearQuadratic& f, const Vector& xi, const Vector& lambda) {
  double gap = 0;
  for (Index a = 0; a < f.rows(); ++a) {
    if (lambda[a] == 0) continue;  // a row that takes no part
    DoubleDouble rest{-f.h[a], 0};
    for (SparseRows::InnerIterator it(f.G, a); it; ++it)
      rest = add(rest, two_product(it.value(), xi[it.col()]));
    gap += lambda[a] * rest.value();
  }
  return gap;
}

Vector defect_terms(const LinearQuadratic& f, const Vector& xi, const Vector& lambda) {
  return f.c.cwiseAbs() + f.H.cwiseAbs() * xi.cwiseAbs() + f.G.cwiseAbs().transpose() * lambda.cwiseAbs();
}

Vector softness_of_entries(const Metric& W) {
  if (W.kind() == MetricKind::identity || W.kind() == MetricKind::diagonal)
    return W.diagonal().cwiseSqrt().cwiseInverse();
  constexpr Index width = 64;  // columns whitened at once
  const Index n = W.dimension();
  Vector found(n);
  for (Index first = 0; first < n; first += width) {
    const Index count = std::min(width, n - first);
    Matrix columns = Matrix::Zero(n, count);
    columns.middleRows(first, count).setIdentity();
    W.whiten_in_place(columns);
    found.segment(first, count) = columns.colwise().norm();
  }
  return found;
}

}  // namespace convex::linear_quadratic
