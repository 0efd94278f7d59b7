#include "convex/metric.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>
#include <string>

#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"
#include "convex/sparse_gram.hpp"
#include "convex/triangular_solve.hpp"

namespace convex {
namespace {

/// A pivot of so many roundings per coordinate of its diagonal entry carries no digit of A: definite or not,
/// doubles cannot tell.
constexpr double pivot_roundings = 4;

/// Two entries a_ij and a_ji that should be equal may differ by so many roundings per coordinate, relative to
/// sqrt(a_ii a_jj), which bounds both: the trace of a matrix computed in doubles. More is a wrong matrix.
constexpr double symmetry_roundings = 16;

bool differ(double a, double b, double diagonal_i, double diagonal_j, Index n) {
  const double slack = symmetry_roundings * unit_roundoff * static_cast<double>(n);
  return std::abs(a - b) > slack * std::sqrt(std::abs(diagonal_i)) * std::sqrt(std::abs(diagonal_j));
}

std::string entry(Index i, Index j) { return "A[" + std::to_string(i) + "][" + std::to_string(j) + "]"; }

[[noreturn]] void refuse_asymmetry(Index i, Index j) {
  throw InvalidInput("A: not symmetric: " + entry(i, j) + " and " + entry(j, i) +
                     " differ; give a symmetric matrix");
}

[[noreturn]] void refuse_indefinite() {
  throw InvalidInput(
      "A: not positive definite to working precision; every motion must have a positive kinetic energy");
}

/// W = Wᵀ, entry by entry, and all finite: what is not differs from itself.
bool is_symmetric(const Matrix& W) {
  const Index n = W.rows();
  Index unequal = 0;
  for (Index j = 0; j < n; ++j) {
    const double *column = W.data() + j * n, *row = W.data() + j;
    for (Index i = 0; i <= j; ++i) unequal += !(column[i] - row[i * n] == 0);
  }
  return unequal == 0;
}

void mirror_lower_triangle(Matrix& L) {
  const Index n = L.rows();
  for (Index j = 0; j < n; ++j) {
    double *column = L.data() + j * n, *row = L.data() + j;
    for (Index i = 0; i < j; ++i) column[i] = row[i * n];
  }
}

void require_finite(double value, Index i, Index j) {
  if (!std::isfinite(value)) throw InvalidInput("A: " + entry(i, j) + " is not finite; give finite numbers");
}

}  // namespace

struct Metric::Data {
  MetricKind kind = MetricKind::identity;
  Vector diagonal;  // of W
  Vector root;      // sqrt of the diagonal, kind diagonal
  Matrix W;         // kind dense
  Matrix L;         // kind dense, the factor in the lower triangle, its transpose in the upper
  std::optional<SparseGram> sparse;
  double factor_condition = 1;
};

Metric Metric::identity(Index n) {
  auto data = std::make_shared<Data>();
  data->diagonal = Vector::Ones(n);
  return Metric(std::move(data));
}

Metric Metric::diagonal(const Vector& d) {
  auto data = std::make_shared<Data>();
  data->kind = MetricKind::diagonal;
  data->diagonal = d;
  for (Index i = 0; i < d.size(); ++i) {
    require_finite(d[i], i, i);
    if (!(d[i] > 0)) refuse_indefinite();
  }
  data->root = d.cwiseSqrt();
  return Metric(std::move(data));
}

Metric Metric::dense(const Matrix& W) {
  if (W.rows() != W.cols())
    throw InvalidInput("A: " + std::to_string(W.rows()) + " rows of " + std::to_string(W.cols()) +
                       " entries; give a square matrix");
  auto data = std::make_shared<Data>();
  const Index n = W.rows();
  data->kind = MetricKind::dense;
  data->W = W;
  if (!is_symmetric(W))
    for (Index j = 0; j < n; ++j)
      for (Index i = 0; i <= j; ++i) {
        const double a = W(i, j), b = W(j, i);
        if (a == b && std::isfinite(a)) continue;
        require_finite(a, i, j);
        require_finite(b, j, i);
        if (differ(a, b, W(i, i), W(j, j), n)) refuse_asymmetry(i, j);
        data->W(i, j) = data->W(j, i) = a + (b - a) / 2;
      }
  data->diagonal = data->W.diagonal();
  data->L = data->W;
  Eigen::LLT<Eigen::Ref<Matrix>> factor(data->L);
  const bool factored = factor.info() == Eigen::Success;
  double smallest = 1;  // of L_ii² / w_ii
  for (Index i = 0; i < n; ++i) {
    const double relative = factored ? data->L(i, i) * data->L(i, i) / data->diagonal[i] : 0;
    if (!(relative > pivot_roundings * unit_roundoff * static_cast<double>(n))) refuse_indefinite();
    smallest = std::min(smallest, relative);
  }
  data->factor_condition = 1 / std::sqrt(smallest);
  mirror_lower_triangle(data->L);
  return Metric(std::move(data));
}

Metric Metric::sparse(const SparseMatrix& W) {
  if (W.rows() != W.cols())
    throw InvalidInput("A: " + std::to_string(W.rows()) + " rows of " + std::to_string(W.cols()) +
                       " entries; give a square matrix");
  auto data = std::make_shared<Data>();
  const Index n = W.rows();
  data->kind = MetricKind::sparse;
  const SparseMatrix transposed = W.transpose();
  const Vector diagonal_of_W = W.diagonal();
  bool is_diagonal = true;
  for (Index j = 0; j < n; ++j) {
    SparseMatrix::InnerIterator a(W, j), b(transposed, j);
    for (; a || b; ++a, ++b) {
      if (!a || !b || a.row() != b.row()) {
        const Index i = !a ? b.row() : !b ? a.row() : std::min(a.row(), b.row());
        refuse_asymmetry(i, j);
      }
      require_finite(a.value(), a.row(), j);
      if (differ(a.value(), b.value(), diagonal_of_W[a.row()], diagonal_of_W[j], n))
        refuse_asymmetry(a.row(), j);
      is_diagonal = is_diagonal && a.row() == j;
    }
  }
  SparseMatrix mean = 0.5 * (W + transposed);
  data->diagonal = mean.diagonal();
  if (is_diagonal) return diagonal(data->diagonal);
  for (Index i = 0; i < n; ++i)
    if (!(data->diagonal[i] > 0)) refuse_indefinite();
  data->sparse.emplace(std::move(mean), pivot_roundings * unit_roundoff * static_cast<double>(n));
  return Metric(std::move(data));
}

Metric Metric::scaled(double factor) const {
  switch (data_->kind) {
    case MetricKind::dense:
      return dense(data_->W * factor);
    case MetricKind::sparse:
      return sparse(data_->sparse->matrix() * factor);
    default:
      return diagonal(data_->diagonal * factor);
  }
}

MetricKind Metric::kind() const { return data_->kind; }
Index Metric::dimension() const { return data_->diagonal.size(); }
const Vector& Metric::diagonal() const { return data_->diagonal; }
double Metric::factor_condition() const {
  return data_->sparse ? data_->sparse->factor_condition() : data_->factor_condition;
}

const Matrix& Metric::dense_gram() const {
  invariant(data_->kind == MetricKind::dense, "a dense Gram matrix is asked of a dense metric");
  return data_->W;
}

const SparseMatrix& Metric::sparse_gram() const {
  invariant(data_->kind == MetricKind::sparse, "a sparse Gram matrix is asked of a sparse metric");
  return data_->sparse->matrix();
}

Vector Metric::multiply(const Vector& x) const {
  switch (data_->kind) {
    case MetricKind::identity:
      return x;
    case MetricKind::diagonal:
      return data_->diagonal.cwiseProduct(x);
    case MetricKind::dense:
      return data_->W * x;
    case MetricKind::sparse:
      return data_->sparse->matrix() * x;
  }
  return x;
}

Vector Metric::solve(const Vector& c) const {
  if (data_->kind == MetricKind::diagonal) return c.cwiseQuotient(data_->diagonal);
  return unwhiten(whiten(c));
}

double Metric::norm(const Vector& x) const {
  switch (data_->kind) {
    case MetricKind::identity:
      return x.norm();
    case MetricKind::diagonal:
      return data_->root.cwiseProduct(x).norm();
    case MetricKind::dense:
      return (data_->L.triangularView<Eigen::Upper>() * x).norm();
    case MetricKind::sparse:
      return data_->sparse->norm(x);
  }
  return 0;
}

Vector Metric::whiten(const Vector& c) const {
  Matrix w = c;
  whiten_in_place(w);
  return w;
}

Vector Metric::unwhiten(const Vector& w) const {
  Vector x = w;
  unwhiten_in_place(x);
  return x;
}

void Metric::whiten_in_place(Eigen::Ref<Matrix> C) const {
  switch (data_->kind) {
    case MetricKind::identity:
      break;
    case MetricKind::diagonal:
      C.array().colwise() /= data_->root.array();
      break;
    case MetricKind::dense:
      solve_lower_triangle(data_->L, C);
      break;
    case MetricKind::sparse:
      data_->sparse->whiten_in_place(C);
      break;
  }
}

void Metric::unwhiten_in_place(Eigen::Ref<Vector> w) const {
  switch (data_->kind) {
    case MetricKind::identity:
      break;
    case MetricKind::diagonal:
      w.array() /= data_->root.array();
      break;
    case MetricKind::dense:
      solve_upper_triangle(data_->L, w);
      break;
    case MetricKind::sparse:
      data_->sparse->unwhiten_in_place(w);
      break;
  }
}

}  // namespace convex
