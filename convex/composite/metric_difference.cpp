#include "convex/composite/metric_difference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace convex::inline composite {
namespace {

/// A correction of this part of what it corrects leaves a rounding of it.
constexpr double root_of_unit_roundoff = 0x1p-27;

constexpr int power_iterations = 12;  // enough for the ends to a factor of 2, which is all that is needed

template <class Apply>
double largest_eigenvalue(Index n, const Apply& apply) {
  Vector v(n);
  // Golden-ratio phases: a start that no structured eigenvector is orthogonal to.
  for (Index i = 0; i < n; ++i) v[i] = 1 + std::fmod(0.6180339887498949 * static_cast<double>(i + 1), 1.0);
  for (Index i = 1; i < n; i += 2) v[i] = -v[i];
  double value = 0;
  for (int step = 0; step < power_iterations; ++step) {
    v /= v.norm();
    v = apply(v);
    value = v.norm();
  }
  return value;
}

}  // namespace

void add_metric_difference(const Metric& W, const Vector& x, const Vector& z, DoubleDoubleVector& sum) {
  const Index n = W.dimension();
  const auto difference = [&](Index j) { return two_sum(x[j], -z[j]); };
  switch (W.kind()) {
    case MetricKind::identity:
      for (Index i = 0; i < n; ++i) {
        const DoubleDouble total = add({sum.hi[i], sum.lo[i]}, difference(i));
        sum.hi[i] = total.hi;
        sum.lo[i] = total.lo;
      }
      break;
    case MetricKind::diagonal:
      for (Index i = 0; i < n; ++i) add_multiple(1, &W.diagonal()[i], difference(i), &sum.hi[i], &sum.lo[i]);
      break;
    case MetricKind::dense:
      for (Index j = 0; j < n; ++j)
        add_multiple(n, W.dense_gram().col(j).data(), difference(j), sum.hi.data(), sum.lo.data());
      break;
    case MetricKind::sparse:
      for (Index j = 0; j < n; ++j)
        for (SparseMatrix::InnerIterator entry(W.sparse_gram(), j); entry; ++entry)
          add_multiple(1, &entry.value(), difference(j), &sum.hi[entry.row()], &sum.lo[entry.row()]);
      break;
  }
}

Vector metric_difference(const Metric& W, const Vector& x, const Vector& z) {
  DoubleDoubleVector sum(W.dimension());
  add_metric_difference(W, x, z, sum);
  return sum.value();
}

Vector refined_solve(const Metric& W, const Vector& c) {
  Vector x = W.solve(c);
  if (W.kind() == MetricKind::identity || W.kind() == MetricKind::diagonal) return x;
  constexpr int most_corrections = 12;
  constexpr double slow = 0.5;
  double last = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < most_corrections; ++pass) {
    const Vector correction = W.solve(excess_of_image(W, x, c));
    const double size = correction.norm();
    if (!(size <= slow * last)) break;
    x -= correction;
    // The next one would be this part of the last, as this is of x.
    if (size <= root_of_unit_roundoff * x.norm()) break;
    last = size;
  }
  return x;
}

Vector excess_of_image(const Metric& W, const Vector& x, const Vector& c) {
  DoubleDoubleVector sum(-c);
  add_metric_difference(W, x, Vector::Zero(c.size()), sum);
  return sum.value();
}

double miss_of_solve(const Metric& W, const Vector& x, const Vector& c) {
  return W.dual_norm(excess_of_image(W, x, c));
}

Matrix gram(const Metric& W) {
  if (W.kind() == MetricKind::dense) return W.dense_gram();
  if (W.kind() == MetricKind::sparse) return Matrix(W.sparse_gram());
  return W.diagonal().asDiagonal();
}

double MetricScales::middle() const { return std::sqrt(smallest) * std::sqrt(largest); }

Vector MetricScales::middle_by_entry() const {
  return (diagonal.array().sqrt() / inverse_diagonal.array().sqrt()).matrix();
}

double MetricScales::norm_of_size(const Vector& size, bool scattered) const {
  const double whole = std::sqrt(largest) * size.norm();
  return scattered ? whole : std::min(whole, size.dot(diagonal.cwiseSqrt()));
}

double MetricScales::dual_norm_of_size(const Vector& size, bool scattered) const {
  const double whole = size.norm() / std::sqrt(smallest);
  return scattered ? whole : std::min(whole, size.dot(inverse_diagonal.cwiseSqrt()));
}

MetricScales metric_scales(const Metric& W) {
  const Index n = W.dimension();
  MetricScales scales;
  scales.diagonal = W.diagonal();
  if (n == 0) return scales;
  if (W.kind() == MetricKind::identity || W.kind() == MetricKind::diagonal) {
    scales.inverse_diagonal = W.diagonal().cwiseInverse();
    scales.smallest = W.diagonal().minCoeff();
    scales.largest = W.diagonal().maxCoeff();
    return scales;
  }
  Matrix columns = Matrix::Identity(n, n);
  W.whiten_in_place(columns);
  scales.inverse_diagonal = columns.colwise().squaredNorm();
  scales.largest = std::max(largest_eigenvalue(n, [&](const Vector& v) { return W.multiply(v); }),
                            scales.diagonal.maxCoeff());
  scales.smallest = 1 / std::max(largest_eigenvalue(n, [&](const Vector& v) { return W.solve(v); }),
                                 scales.inverse_diagonal.maxCoeff());
  return scales;
}

}  // namespace convex::inline composite
