#include "convex/proved_prox/doubles/metric_bounds.hpp"

#include <cmath>

#include "convex/exact/rounding_bounds.hpp"
#include "convex/interval_arithmetic.hpp"

namespace convex::near_graphs {
namespace {

/// The largest sum of sizes in a row is at least the largest eigenvalue.
double largest_row(const Matrix& sizes) { return above(sizes.rowwise().sum().maxCoeff()); }

/// Tried as parts of an estimate of the least eigenvalue.
constexpr double parts_of_estimate[] = {0.9, 0.5, 0.1};

/// Cholesky's method in place, the lower half; false at a pivot that is not positive.
bool has_factor(Matrix L) {
  for (Index j = 0; j < L.cols(); ++j) {
    const double pivot = L(j, j);
    if (!(pivot > 0)) return false;
    const Index below_j = L.rows() - j - 1;
    L.col(j).tail(below_j) /= pivot;
    for (Index k = j + 1; k < L.cols(); ++k)
      L.col(k).tail(L.rows() - k) -= (pivot * L(k, j)) * L.col(j).tail(L.rows() - k);
  }
  return true;
}

}  // namespace

double least_eigenvalue_below(const Matrix& W) {
  const Index n = W.rows();
  if (n == 0 || !is_ordinary(W) || !has_factor(W)) return 0;
  const double trace = above(W.diagonal().cwiseAbs().sum());
  // Each entry of the exact matrix may be off its double by half a unit, and the shifted diagonal by another.
  const double lost = above(8 * gamma(n + 2) * trace);
  const Metric metric = Metric::dense(W);
  // Inverse iteration: an estimate, nothing more.
  Vector q = Vector::LinSpaced(n, 1, 2).normalized();
  double estimate = 0;
  constexpr int iterations = 6;
  for (int k = 0; k < iterations; ++k) {
    q = metric.solve(q);
    estimate = 1 / q.norm();
    q *= estimate;
  }
  for (const double part : parts_of_estimate) {
    const double shift = part * estimate;
    if (shift > 2 * lost && has_factor(W - shift * Matrix::Identity(n, n))) return below(shift - lost);
  }
  return 0;
}

bool MetricBounds::is_diagonal() const {
  return W_.kind() == MetricKind::identity || W_.kind() == MetricKind::diagonal;
}

MetricBounds::MetricBounds(const Metric& W, double relative_error) : W_(W), error_(relative_error) {
  if (W.kind() == MetricKind::identity) {
    least_ = most_ = 1;
  } else if (W.kind() == MetricKind::diagonal) {
    least_ = moved_down(W.diagonal().minCoeff());
    most_ = moved_up(W.diagonal().maxCoeff());
  } else {
    gram_ = W.kind() == MetricKind::sparse ? Matrix(W.sparse_gram()) : W.dense_gram();
    sizes_ = gram_.cwiseAbs();
    least_ = least_eigenvalue_below(gram_);
    most_ = above(largest_row(sizes_));
  }
}

double MetricBounds::norm_above(const Vector& size) const {
  if (W_.kind() == MetricKind::identity) return convex::norm_above(size);
  if (is_diagonal()) return convex::norm_above(Vector(size.cwiseProduct(W_.diagonal().cwiseSqrt())));
  return above(std::sqrt(above(size.dot(sizes_ * size)))) * (1 + error_);
}

double MetricBounds::norm_above(const Vector& d, const Vector& radius) const {
  if (is_diagonal()) return norm_above(Vector(d.cwiseAbs() + radius));
  const Vector size = d.cwiseAbs();
  const double square = d.dot(gram_ * d) + (2 * gamma(d.size()) + error_) * size.dot(sizes_ * size);
  return above(std::sqrt(above(std::max(square, 0.0))) + norm_above(radius));
}

double MetricBounds::norm_above(double ball) const { return ball > 0 ? above(ball * std::sqrt(most_)) : 0; }

double MetricBounds::dual_norm_above(double ball) const {
  return ball > 0 ? above(ball / std::sqrt(least_)) : 0;
}

double MetricBounds::dual_norm_above(const Vector& c, const Vector& radius) const {
  if (!is_proved_definite()) return INFINITY;
  if (W_.kind() == MetricKind::identity) return convex::norm_above(Vector(c.cwiseAbs() + radius));
  if (is_diagonal())
    return convex::norm_above(Vector((c.cwiseAbs() + radius).cwiseQuotient(W_.diagonal().cwiseSqrt())));
  // ||c'|| <= ||e||_W + |c' - We|₂ / sqrt(least), e near W⁻¹c.
  const Vector e = W_.solve(c);
  Vector product = e, left = Vector::Zero(e.size());
  multiply(product, left);
  left += radius;
  const Vector miss = (c - product).cwiseAbs() * (1 + 4 * unit_roundoff) + left;
  return above(norm_above(e, Vector::Zero(e.size())) + dual_norm_above(convex::norm_above(miss)));
}

void MetricBounds::multiply(Vector& x, Vector& radius) const {
  if (W_.kind() == MetricKind::identity) return;
  if (is_diagonal()) {
    const Vector& d = W_.diagonal();
    radius = (d.cwiseProduct(radius) + (error_ + unit_roundoff) * d.cwiseProduct(x.cwiseAbs())) *
             (1 + 8 * unit_roundoff);
    radius.array() += 1e-320;
    x = x.cwiseProduct(d);
    return;
  }
  radius = (sizes_ * (radius + (gamma(x.size()) + error_) * x.cwiseAbs())) * (1 + 0x1p-30);
  x = gram_ * x;
}

}  // namespace convex::near_graphs
