#include "convex/metric.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "convex/dense/recycled.hpp"
#include "convex/dense/triangular_solve.hpp"
#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"
#include "convex/linear_algebra/padded_triangle.hpp"
#include "convex/processor.hpp"
#include "convex/sparse_gram.hpp"

namespace convex {
namespace {

/// A pivot, of its diagonal entry, or a least eigenvalue, of a diagonal of ones, of so many roundings per
/// coordinate carries no digit of A.
constexpr double pivot_roundings = 4, eigenvalue_roundings = 2;

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

[[noreturn]] void refuse_indefinite(const Vector& diagonal) {
  for (Index i = 0; i < diagonal.size(); ++i) {
    if (!(diagonal[i] > 0))
      throw InvalidInput("A: not positive definite: " + entry(i, i) +
                         " is not positive; give a symmetric positive definite matrix");
    if (diagonal[i] < std::numeric_limits<double>::min())
      throw InvalidInput("A: " + entry(i, i) +
                         " is below 2.2e-308, where doubles lose their digits; measure in other units");
  }
  throw InvalidInput(
      "A: not positive definite to working precision; give a symmetric positive definite matrix");
}

void require_size(Index m, Index n) {
  if (m != n) throw InvalidInput("metric: size " + std::to_string(m) + "; give size " + std::to_string(n));
}

void require_finite(double value, Index i, Index j) {
  if (!std::isfinite(value)) throw InvalidInput("A: " + entry(i, j) + " is not finite; give finite numbers");
}

/// ½ (W + Wᵀ), which may differ from W by rounding.
SparseMatrix mean_with_transpose(const SparseMatrix& W) {
  const Index n = W.rows();
  const SparseMatrix transposed = W.transpose();
  const Vector diagonal = W.diagonal();
  for (Index j = 0; j < n; ++j) {
    SparseMatrix::InnerIterator a(W, j), b(transposed, j);
    for (; a || b; ++a, ++b) {
      if (!a || !b || a.row() != b.row()) {
        const Index i = !a ? b.row() : !b ? a.row() : std::min(a.row(), b.row());
        refuse_asymmetry(i, j);
      }
      require_finite(a.value(), a.row(), j);
      if (differ(a.value(), b.value(), diagonal[a.row()], diagonal[j], n)) refuse_asymmetry(a.row(), j);
    }
  }
  return 0.5 * (W + transposed);
}

/// Sets pairs of entries of W that should be equal to their mean. False when some differ by more than
/// rounding or are not finite. By tiles, for the rows of a large matrix are far apart in memory.
bool make_symmetric(Matrix& W) {
  constexpr Index tile = 8;
  const Index n = W.rows();
  const double slack = symmetry_roundings * unit_roundoff * static_cast<double>(n);
  const Vector root = W.diagonal().cwiseAbs().cwiseSqrt(), bound = slack * root;
  Index wrong = 0;
  for (Index first = 0; first < n; first += tile)
    for (Index above = 0; above <= first; above += tile)
      for (Index j = first; j < std::min(n, first + tile); ++j) {
        double *const column = W.data() + j * n, *const row = W.data() + j;
        for (Index i = above; i < std::min(j, above + tile); ++i) {
          const double a = column[i], b = row[i * n], difference = b - a;
          wrong += !(std::abs(difference) <= bound[i] * root[j]);
          column[i] = row[i * n] = a + difference / 2;
        }
      }
  for (Index i = 0; i < n; ++i) wrong += !std::isfinite(W(i, i));
  return wrong == 0;
}

/// How many of the numbers are positive and finite, without a branch.
MOREAU_CLONES
Index count_positive(Index n, const double* x) {
  Index count = 0;
  for (Index i = 0; i < n; ++i)
    count += (x[i] > 0 ? 1 : 0) & (x[i] <= std::numeric_limits<double>::max() ? 1 : 0);
  return count;
}

[[noreturn]] void refuse_unequal(const Matrix& W) {
  const Index n = W.rows();
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i <= j; ++i) {
      require_finite(W(i, j), i, j);
      require_finite(W(j, i), j, i);
      if (differ(W(i, j), W(j, i), W(i, i), W(j, j), n)) refuse_asymmetry(i, j);
    }
  refuse_asymmetry(0, n - 1);
}

}  // namespace

struct Metric::Data {
  MetricKind kind = MetricKind::identity;
  Vector diagonal;                          // of W
  Matrix W;                                 // kind dense
  linear_algebra::PaddedTriangle triangle;  // kind dense
  std::optional<SparseGram> sparse;
  double factor_condition = 1;

  static bool is_small(const Data& data) { return data.W.rows() <= 300; }  // 1.5 MB

  /// The largest w_ii / L_ii²; infinite where a pivot is not a positive number.
  double pivot_loss() const {
    double largest = 1;
    for (Index i = 0; i < diagonal.size(); ++i) {
      const double over = triangle.inverse()[i / 8 * 128 + i % 8 * 9],
                   loss = std::abs(diagonal[i] * over * over);
      if (!std::isfinite(loss)) return infinity;
      largest = std::max(largest, loss);
    }
    return largest;
  }
};

Metric Metric::identity(Index n) {
  if (n < 0) throw InvalidInput("metric: a negative dimension; give 0 or more");
  auto data = std::make_shared<Data>();
  data->diagonal = Vector::Ones(n);
  return Metric(std::move(data));
}

Metric Metric::diagonal(const Vector& d) {
  auto data = std::make_shared<Data>();
  data->kind = MetricKind::diagonal;
  data->diagonal = d;
  const Index right = count_positive(d.size(), d.data());
  for (Index i = 0; i < d.size() && right < d.size(); ++i) {
    require_finite(d[i], i, i);
    if (!(d[i] > 0)) refuse_indefinite(d);
  }
  return Metric(std::move(data));
}

Metric Metric::dense(const Matrix& W) {
  if (W.rows() != W.cols())
    throw InvalidInput("A: " + std::to_string(W.rows()) + " by " + std::to_string(W.cols()) +
                       "; give a square matrix");
  const std::shared_ptr<Data> data = Recycled<Data, Data::is_small>::one();
  const Index n = W.rows();
  data->kind = MetricKind::dense;
  data->W = W;
  if (!data->triangle.take(W)) {
    if (!make_symmetric(data->W)) refuse_unequal(W);
    data->triangle.take(data->W);
  }
  data->diagonal = data->W.diagonal();
  data->triangle.factor();
  const double loss = data->pivot_loss(), rounding = unit_roundoff * static_cast<double>(n);
  bool is_definite = loss * (pivot_roundings * rounding) < 1;
  if (is_definite && loss * plain_pivot > 1) {
    Matrix inverse = data->diagonal.cwiseSqrt().asDiagonal();  // L⁻¹D^½: norm² >= 1 / eigenvalue
    solve_lower_triangle(data->triangle.view(), inverse);
    is_definite = inverse.squaredNorm() * (eigenvalue_roundings * rounding) < 1;
  }
  if (!is_definite) refuse_indefinite(data->diagonal);
  data->factor_condition = std::sqrt(loss);
  return Metric(std::move(data));
}

Metric Metric::dense(const Matrix& W, const Matrix& L) {
  auto data = std::make_shared<Data>();
  data->kind = MetricKind::dense;
  data->W = W;
  data->diagonal = W.diagonal();
  data->triangle.take_factor(L);
  data->factor_condition = std::sqrt(data->pivot_loss());
  return Metric(std::move(data));
}

Metric Metric::sparse(const SparseMatrix& W) {
  if (W.rows() != W.cols())
    throw InvalidInput("A: " + std::to_string(W.rows()) + " by " + std::to_string(W.cols()) +
                       "; give a square matrix");
  auto data = std::make_shared<Data>();
  const Index n = W.rows();
  data->kind = MetricKind::sparse;
  SparseMatrix mean = is_exactly_symmetric(W) ? W : mean_with_transpose(W);
  data->diagonal = mean.diagonal();
  bool is_diagonal = true;
  for (Index j = 0; j < n && is_diagonal; ++j)
    for (SparseMatrix::InnerIterator it(mean, j); it; ++it) is_diagonal = is_diagonal && it.row() == j;
  if (is_diagonal) return diagonal(data->diagonal);
  for (Index i = 0; i < n; ++i)
    if (!(data->diagonal[i] > 0)) refuse_indefinite(data->diagonal);
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

DenseFactor Metric::dense_factor() const {
  invariant(data_->kind == MetricKind::dense, "a dense factor is asked of a dense metric");
  const linear_algebra::PaddedTriangle& factor = data_->triangle;
  return {factor.ld(), factor.T(), factor.inverse()};
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
  require_size(x.size(), dimension());
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
  require_size(c.size(), dimension());
  if (data_->kind == MetricKind::diagonal) return c.cwiseQuotient(data_->diagonal);
  return unwhiten(whiten(c));
}

double Metric::norm(const Vector& x) const {
  require_size(x.size(), dimension());
  const auto plain_norm = [&](const Vector& u) {
    switch (data_->kind) {
      case MetricKind::identity:
        return u.norm();
      case MetricKind::diagonal:
        return data_->diagonal.cwiseSqrt().cwiseProduct(u).norm();
      case MetricKind::dense:
        return (data_->triangle.view().triangularView<Eigen::Upper>() * u).norm();
      case MetricKind::sparse:
        return data_->sparse->norm(u);
    }
    return 0.0;
  };
  const double plain = plain_norm(x);
  if (has_squares(plain) || x.isZero(0)) return plain;
  const double size = x.cwiseAbs().maxCoeff();
  return size > 0 && std::isfinite(size) ? size * plain_norm(x / size) : plain;
}

double Metric::dual_norm(const Vector& c) const {
  const Vector whitened = whiten(c);
  const double plain = whitened.norm();
  return has_squares(plain) ? plain : whitened.stableNorm();
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
  require_size(C.rows(), dimension());
  switch (data_->kind) {
    case MetricKind::identity:
      break;
    case MetricKind::diagonal:
      C.array().colwise() /= Vector(data_->diagonal.cwiseSqrt()).array();
      break;
    case MetricKind::dense:
      solve_lower_triangle(data_->triangle.view(), C);
      break;
    case MetricKind::sparse:
      data_->sparse->whiten_in_place(C);
      break;
  }
}

void Metric::unwhiten_in_place(Eigen::Ref<Vector> w) const {
  require_size(w.size(), dimension());
  switch (data_->kind) {
    case MetricKind::identity:
      break;
    case MetricKind::diagonal:
      w.array() /= data_->diagonal.array().sqrt();
      break;
    case MetricKind::dense:
      solve_upper_triangle(data_->triangle.view(), w);
      break;
    case MetricKind::sparse:
      data_->sparse->unwhiten_in_place(w);
      break;
  }
}

}  // namespace convex
