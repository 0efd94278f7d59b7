#pragma once

#include <memory>

#include "convex/vector.hpp"

namespace convex {

/// How a Gram matrix is stored; a fact that methods use to choose their path.
enum class MetricKind { identity, diagonal, dense, sparse };

/// The factor of a dense W as `DenseKernels` wants it: ld×ld, padded, L below and Lᵀ above; inverse: of
/// the blocks on the diagonal.
struct DenseFactor {
  Index ld = 0;
  const double *T = nullptr, *inverse = nullptr;
};

/// A Euclidean metric (x|y) = x·Wy, W n×n symmetric positive definite, factored once as W = F Fᵀ with
/// F = L (dense), sqrt(W) (diagonal) or PᵀL (sparse, P a fill-reducing permutation). Immutable; copies share
/// the factor.
///
/// W maps vectors to covectors. Whitening turns the metric into the plain one:
///   whiten(c) = F⁻¹c, |whiten(c)|₂ = ||c||_(W⁻¹);   unwhiten(w) = F⁻ᵀw, ||unwhiten(w)||_W = |w|₂.
class Metric {
 public:
  static Metric identity(Index n);
  /// Throws InvalidInput naming the first entry that is not positive and finite.
  static Metric diagonal(const Vector& d);
  /// Throws InvalidInput when W is not square, not finite, not symmetric (entries may differ by rounding: 8
  /// units in the last place; their mean is then meant), or not positive definite to working precision.
  static Metric dense(const Matrix& W);
  /// The same of a W whose factor is known, W = L Lᵀ but for the rounding of W: for one that is positive
  /// definite by less than its rounding in doubles, which `dense(W)` cannot tell. W and L: n×n, finite, W
  /// symmetric, L lower with a positive diagonal.
  static Metric dense(const Matrix& W, const Matrix& L);
  static Metric sparse(const SparseMatrix& W);

  /// factor W, factor > 0. A step of a prox is a metric: W / gamma.
  Metric scaled(double factor) const;

  MetricKind kind() const;
  Index dimension() const;
  /// The diagonal of W: n.
  const Vector& diagonal() const;

  /// Wx: from a vector to its covector.
  Vector multiply(const Vector& x) const;
  /// W⁻¹c: from a covector to its vector.
  Vector solve(const Vector& c) const;
  double inner(const Vector& x, const Vector& y) const { return x.dot(multiply(y)); }
  /// ||x||_W, also where squares are no ordinary doubles.
  double norm(const Vector& x) const;
  /// ||c||_(W⁻¹), likewise.
  double dual_norm(const Vector& c) const;

  Vector whiten(const Vector& c) const;
  Vector unwhiten(const Vector& w) const;
  /// F⁻¹C in place, one covector a column.
  void whiten_in_place(Eigen::Ref<Matrix> C) const;
  /// F⁻ᵀw in place.
  void unwhiten_in_place(Eigen::Ref<Vector> w) const;

  /// W itself, as stored; each may be asked for its own kind only.
  const Matrix& dense_gram() const;
  const SparseMatrix& sparse_gram() const;
  DenseFactor dense_factor() const;

  /// max sqrt(w_ii) / min |F_ii|: a cheap lower estimate of the condition number of F.
  double factor_condition() const;

 private:
  struct Data;
  explicit Metric(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace convex
