#include "convex/operations/metric_algebra.hpp"

#include <cmath>

#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"
#include "convex/linear_algebra/cholesky.hpp"
#include "convex/linear_algebra/householder.hpp"
#include "convex/linear_algebra/singular_values.hpp"

namespace convex::inline operations {
namespace {

/// Entries that differ by so many roundings per term of the sums they come from are equal.
constexpr double equality_roundings = 8;

/// Rows whose smallest singular value is so small a part of the largest are dependent: the Gram matrix of the
/// image, which has the square of it, keeps no digit below.
constexpr double smallest_independent = 1e-7;

bool is_diagonal(const SparseMatrix& Q) {
  for (Index j = 0; j < Q.outerSize(); ++j)
    for (SparseMatrix::InnerIterator entry(Q, j); entry; ++entry)
      if (entry.row() != j && entry.value() != 0) return false;
  return true;
}

/// W as a sparse matrix; W is not dense.
SparseMatrix stored(const Metric& W) {
  if (W.kind() == MetricKind::sparse) return W.sparse_gram();
  SparseMatrix D(W.dimension(), W.dimension());
  D.setIdentity();
  for (Index i = 0; i < W.dimension(); ++i) D.coeffRef(i, i) = W.diagonal()[i];
  return D;
}

Matrix symmetric(const Matrix& M) { return 0.5 * (M + M.transpose()); }

Matrix inverse_gram(const Matrix& W) { return symmetric(linear_algebra::Cholesky(W).inverse()); }

}  // namespace

bool is_diagonal_kind(const Metric& W) {
  return W.kind() == MetricKind::identity || W.kind() == MetricKind::diagonal;
}

Metric times(double factor, const Metric& W) {
  if (!(factor > 0) || !std::isfinite(factor))
    throw InvalidInput("metric: the factor is not positive and finite; give another step or scale");
  return factor == 1 ? W : W.scaled(factor);
}

Metric plus(const Metric& W, const SparseMatrix& Q) {
  invariant(Q.rows() == W.dimension() && Q.cols() == W.dimension(),
            "a matrix added to a metric has its size");
  if (is_diagonal_kind(W) && is_diagonal(Q)) return Metric::diagonal(W.diagonal() + Q.diagonal());
  if (W.kind() == MetricKind::dense || Q.nonZeros() > Q.size() / dense_above)
    return Metric::dense(gram(W) + Matrix(Q));
  return Metric::sparse(stored(W) + Q);
}

Metric plus(const Metric& W, const Metric& V) {
  invariant(V.dimension() == W.dimension(), "added metrics have one size");
  if (is_diagonal_kind(W) && is_diagonal_kind(V)) return Metric::diagonal(W.diagonal() + V.diagonal());
  if (W.kind() == MetricKind::dense || V.kind() == MetricKind::dense) return Metric::dense(gram(W) + gram(V));
  return Metric::sparse(stored(W) + stored(V));
}

Metric inverse(const Metric& W) {
  if (W.kind() == MetricKind::identity) return W;
  if (W.kind() == MetricKind::diagonal) return Metric::diagonal(W.diagonal().cwiseInverse());
  return Metric::dense(inverse_gram(gram(W)));
}

std::optional<double> ratio(const Metric& V, const Metric& W) {
  const Index n = W.dimension();
  if (V.dimension() != n || n == 0) return std::nullopt;
  const double factor = V.diagonal()[0] / W.diagonal()[0];
  const double slack = equality_roundings * unit_roundoff;
  const auto agree = [&](const auto& a, const auto& b) {
    return (a - factor * b).cwiseAbs().maxCoeff() <= slack * a.cwiseAbs().maxCoeff();
  };
  for (Index i = 0; i < n; ++i)
    if (std::abs(V.diagonal()[i] - factor * W.diagonal()[i]) > slack * V.diagonal()[i]) return std::nullopt;
  if (is_diagonal_kind(V) && is_diagonal_kind(W)) return factor;
  if (is_diagonal_kind(V) != is_diagonal_kind(W)) return std::nullopt;
  const Matrix dense_V = gram(V), dense_W = gram(W);
  for (Index j = 0; j < n; ++j)
    if (!agree(dense_V.col(j), dense_W.col(j))) return std::nullopt;
  return factor;
}

Metric parallel_sum(const Metric& W, const Metric& V) {
  if (const auto factor = ratio(V, W)) return times(*factor / (1 + *factor), W);
  if (is_diagonal_kind(W) && is_diagonal_kind(V)) {
    const auto w = W.diagonal().array(), v = V.diagonal().array();
    return Metric::diagonal((w.min(v) / (1 + w.min(v) / w.max(v))).matrix());
  }
  // V - V (W + V)⁻¹ V = W (W + V)⁻¹ V; the product has no cancellation.
  const Matrix dense_W = gram(W), dense_V = gram(V);
  return Metric::dense(
      symmetric(dense_W * linear_algebra::Cholesky(dense_W + dense_V).solve_columns(dense_V)));
}

Metric congruence(const Metric& M, const Metric& W) {
  if (const auto factor = ratio(M, W)) return times(*factor, M);
  if (M.kind() == MetricKind::identity) return inverse(W);
  if (is_diagonal_kind(M) && is_diagonal_kind(W))
    return Metric::diagonal(M.diagonal().cwiseAbs2().cwiseQuotient(W.diagonal()));
  Matrix C = gram(M);
  W.whiten_in_place(C);
  return Metric::dense(symmetric(C.transpose() * C));
}

Metric block(const Metric& W, Index first, Index size) {
  switch (W.kind()) {
    case MetricKind::identity:
      return Metric::identity(size);
    case MetricKind::diagonal:
      return Metric::diagonal(W.diagonal().segment(first, size));
    case MetricKind::dense:
      return Metric::dense(W.dense_gram().block(first, first, size, size));
    case MetricKind::sparse: {
      const SparseMatrix columns = W.sparse_gram().middleCols(first, size);
      const SparseRows rows = SparseRows(columns).middleRows(first, size);
      return Metric::sparse(SparseMatrix(rows));
    }
  }
  return W;
}

bool couples(const Metric& W, const std::vector<Index>& sizes) {
  if (is_diagonal_kind(W)) return false;
  std::vector<Index> owner;
  for (std::size_t k = 0; k < sizes.size(); ++k)
    owner.insert(owner.end(), static_cast<std::size_t>(sizes[k]), static_cast<Index>(k));
  invariant(static_cast<Index>(owner.size()) == W.dimension(), "the blocks fill the metric");
  const auto apart = [&](Index i, Index j) {
    return owner[static_cast<std::size_t>(i)] != owner[static_cast<std::size_t>(j)];
  };
  if (W.kind() == MetricKind::sparse) {
    for (Index j = 0; j < W.dimension(); ++j)
      for (SparseMatrix::InnerIterator entry(W.sparse_gram(), j); entry; ++entry)
        if (entry.value() != 0 && apart(entry.row(), j)) return true;
    return false;
  }
  for (Index j = 0; j < W.dimension(); ++j)
    for (Index i = 0; i < j; ++i)
      if (W.dense_gram()(i, j) != 0 && apart(i, j)) return true;
  return false;
}

std::optional<ImageMetric> image_metric(const Metric& W, const Matrix& A) {
  const Index m = A.rows(), n = A.cols();
  if (m == 0 || m > n) return std::nullopt;
  Matrix V = A.transpose();
  W.whiten_in_place(V);
  const Vector lengths = V.colwise().norm();
  if (!(lengths.minCoeff() > 0)) return std::nullopt;
  Matrix lift = V;
  for (Index j = 0; j < m; ++j) W.unwhiten_in_place(lift.col(j));

  const Matrix unit = V * lengths.cwiseInverse().asDiagonal();
  const Matrix cosines = unit.transpose() * unit;
  const double slack = equality_roundings * unit_roundoff * std::sqrt(static_cast<double>(n));
  if ((cosines - Matrix(cosines.diagonal().asDiagonal())).cwiseAbs().maxCoeff() <= slack) {
    Vector squares = lengths.cwiseAbs2();
    const double mean = squares.mean();
    if ((squares.array() - mean).abs().maxCoeff() <= slack * mean) squares.setConstant(mean);
    const double condition = lengths.maxCoeff() / lengths.minCoeff();
    return ImageMetric{Metric::diagonal(squares.cwiseInverse()), std::move(lift), condition};
  }

  // Rows of any length may be independent: the singular values are those of unit rows.
  const Vector sigma = linear_algebra::singular_values(unit);
  const double condition = sigma[0] / sigma[m - 1];
  if (!(sigma[m - 1] > smallest_independent * sigma[0])) return std::nullopt;
  Matrix R_inverse = Matrix::Identity(m, m);
  linear_algebra::Householder(V).solve_R_in_place(R_inverse);  // (VᵀV)⁻¹ = R⁻¹R⁻ᵀ
  return ImageMetric{Metric::dense(symmetric(R_inverse * R_inverse.transpose())), std::move(lift), condition};
}

}  // namespace convex::inline operations
