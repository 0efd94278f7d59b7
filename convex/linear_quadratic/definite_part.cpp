#include "convex/linear_quadratic/definite_part.hpp"

#include <cmath>

#include "convex/infinity.hpp"
#include "convex/linear_algebra/cholesky.hpp"

namespace convex::linear_quadratic {
namespace {

/// H on the auxiliary variables counts as definite when its factor, scaled to a unit diagonal, has no pivot
/// below this; more than that is left to the proximal-point method.
constexpr double definite_pivot = 1e-4;

/// Up to this many variables a dense factor costs less than the bookkeeping of a sparse one.
constexpr Index dense_limit = 300;

bool is_diagonal(const SparseMatrix& H) {
  for (Index j = 0; j < H.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(H, j); it; ++it)
      if (it.row() != j) return false;
  return true;
}

/// Whether H is definite on the auxiliary variables with curvature of their own.
bool is_definite(const LinearQuadratic& f, const Vector& diagonal) {
  std::vector<Index> block;
  for (Index j = f.n; j < f.variables(); ++j)
    if (diagonal[j] > 0) block.push_back(j);
  const SparseMatrix ww = f.H.bottomRightCorner(f.auxiliaries(), f.auxiliaries());
  if (is_diagonal(ww)) return true;
  Matrix M(static_cast<Index>(block.size()), static_cast<Index>(block.size()));
  const Matrix dense = Matrix(ww);
  for (std::size_t i = 0; i < block.size(); ++i)
    for (std::size_t j = 0; j < block.size(); ++j)
      M(static_cast<Index>(i), static_cast<Index>(j)) =
          dense(block[i] - f.n, block[j] - f.n) / std::sqrt(diagonal[block[i]] * diagonal[block[j]]);
  const linear_algebra::Cholesky factor(M);
  return factor.is_definite() && factor.diagonal().minCoeff() >= definite_pivot;
}

/// sqrt(Σ u_i² / curvature_i) over the definite variables of each row, the metric's part by its own factor.
Vector definite_lengths(const LinearQuadratic& f, const Metric& W, const Vector& diagonal,
                        const std::vector<bool>& is_soft) {
  Matrix columns = Matrix(f.G).leftCols(f.n).transpose();
  W.whiten_in_place(columns);
  Vector squares = columns.colwise().squaredNorm().transpose();
  for (Index a = 0; a < f.rows(); ++a)
    for (SparseRows::InnerIterator it(f.G, a); it; ++it)
      if (it.col() >= f.n && !is_soft[static_cast<std::size_t>(it.col())])
        squares[a] += it.value() * it.value() / diagonal[it.col()];
  return squares.cwiseSqrt();
}

/// Least curvature g_aj² / length_a² over the rows, carried on from soft variable to soft variable. One that
/// underflows, or overflows, tells no scale.
void spread_curvature(const LinearQuadratic& f, const Vector& diagonal, const Vector& length,
                      const std::vector<bool>& is_soft, Vector& curvature) {
  const auto soft = [&](Index j) { return is_soft[static_cast<std::size_t>(j)]; };
  Vector least = Vector::Constant(f.variables(), infinity);
  for (Index a = 0; a < f.rows(); ++a)
    if (length[a] > 0)
      for (SparseRows::InnerIterator it(f.G, a); it; ++it)
        if (const double square = std::pow(it.value() / length[a], 2); soft(it.col()) && square > 0)
          least[it.col()] = std::min(least[it.col()], square);
  for (Index j = 0; j < f.variables(); ++j)
    if (soft(j) && diagonal[j] > 0) least[j] = std::min(least[j], diagonal[j]);
  for (bool changed = true; changed;) {
    changed = false;
    const Vector known = least;
    for (Index a = 0; a < f.rows(); ++a) {
      double row = infinity;  // curvature in the units of this row
      for (SparseRows::InnerIterator it(f.G, a); it; ++it)
        if (soft(it.col())) row = std::min(row, known[it.col()] / (it.value() * it.value()));
      if (row == infinity) continue;
      for (SparseRows::InnerIterator it(f.G, a); it; ++it)
        if (const double square = row * it.value() * it.value();
            soft(it.col()) && known[it.col()] == infinity && square > 0 && square < infinity) {
          least[it.col()] = std::min(least[it.col()], square);
          changed = true;
        }
    }
  }
  const double rest = least.minCoeff() < infinity ? least.minCoeff() : 1;
  for (Index j = 0; j < f.variables(); ++j)
    if (soft(j)) curvature[j] = least[j] < infinity ? least[j] : rest;
}

}  // namespace

SoftVariables soft_variables(const LinearQuadratic& f, const Metric& W) {
  const Vector diagonal = f.H.diagonal();
  const bool definite = is_definite(f, diagonal);
  SoftVariables found{Vector::Zero(f.variables()), false, f.n > 0};
  std::vector<bool> is_soft(static_cast<std::size_t>(f.variables()), false);
  for (Index j = f.n; j < f.variables(); ++j) {
    const bool soft = !(diagonal[j] > 0) || !definite;
    is_soft[static_cast<std::size_t>(j)] = soft;
    (soft ? found.any : found.mixed) = true;
    if (diagonal[j] > 0) found.mixed = true;
  }
  if (!found.any) return found;
  const Vector length = definite_lengths(f, W, diagonal, is_soft);
  spread_curvature(f, diagonal, length, is_soft, found.curvature);
  return found;
}

Metric curvature_metric(const LinearQuadratic& f, const Metric& W, const Vector& extra) {
  const Index N = f.variables();
  const bool plain = W.kind() == MetricKind::identity || W.kind() == MetricKind::diagonal;
  if (plain && is_diagonal(f.H)) {
    Vector d = f.H.diagonal() + extra;
    d.head(f.n) += W.diagonal();
    return Metric::diagonal(d);
  }
  if (W.kind() == MetricKind::dense || N <= dense_limit) {
    Matrix A = Matrix(f.H);
    A.diagonal() += extra;
    if (plain)
      A.diagonal().head(f.n) += W.diagonal();
    else if (W.kind() == MetricKind::dense)
      A.topLeftCorner(f.n, f.n) += W.dense_gram();
    else
      A.topLeftCorner(f.n, f.n) += Matrix(W.sparse_gram());
    return Metric::dense(A);
  }
  std::vector<Eigen::Triplet<double>> entries;
  const auto take = [&](const SparseMatrix& part) {
    for (Index j = 0; j < part.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(part, j); it; ++it)
        entries.emplace_back(static_cast<int>(it.row()), static_cast<int>(j), it.value());
  };
  take(f.H);
  if (W.kind() == MetricKind::sparse) take(W.sparse_gram());
  for (Index j = 0; j < N; ++j) {
    const double own = plain && j < f.n ? W.diagonal()[j] : 0;
    entries.emplace_back(static_cast<int>(j), static_cast<int>(j), extra[j] + own);
  }
  SparseMatrix A(N, N);
  A.setFromTriplets(entries.begin(), entries.end());
  return Metric::sparse(A);
}

}  // namespace convex::linear_quadratic
