#pragma once

#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>

#include "convex/dense/triangular_solve.hpp"
#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// The factorisation V = QR of the whitened active rows v_1 … v_k (columns of V, n×k), kept up to date as
/// rows come and go: Q n×k with orthonormal columns, R k×k upper triangular. Gram-Schmidt with
/// reorthogonalisation and Givens rotations, after Daniel, Gragg, Kaufman and Stewart (1976). Room for
/// `capacity` rows is taken once.
class OrthogonalFactor {
 public:
  OrthogonalFactor(Index n, Index capacity)
      : Q_(n, capacity), R_(capacity, capacity), scratch_(capacity), lengths_(capacity) {}

  Index size() const { return size_; }
  Index capacity() const { return Q_.cols(); }
  auto Q() const { return Q_.leftCols(size_); }
  /// |v_j|₂ of the j-th row.
  double length(Index j) const { return lengths_[j]; }

  /// Splits v = Q c + d with d orthogonal to the columns of Q; on entry d = v. Returns |d|.
  double split(Eigen::Ref<Vector> d, Eigen::Ref<Vector> c) {
    const double before = d.norm();
    c.head(size_).noalias() = Q().transpose() * d;
    d.noalias() -= Q() * c.head(size_);
    double after = d.norm();
    // Kahan's "twice is enough": a second pass restores orthogonality lost to cancellation.
    if (size_ > 0 && after < cancellation * before) {
      scratch_.head(size_).noalias() = Q().transpose() * d;
      d.noalias() -= Q() * scratch_.head(size_);
      c.head(size_) += scratch_.head(size_);
      after = d.norm();
    }
    return after;
  }

  /// Takes in the row v = Q c + d, where |d| = rho > 0.
  template <class Coefficients, class Direction>
  void append(const Coefficients& c, const Direction& d, double rho) {
    R_.col(size_).head(size_) = c.head(size_);
    R_(size_, size_) = rho;
    Q_.col(size_) = d / rho;
    lengths_[size_] = R_.col(size_).head(size_ + 1).norm();
    ++size_;
    inverse_norm_ = 0;
  }

  /// Takes in the columns of `block` (whitened rows; overwritten) that are not dependent on those before
  /// them, to the relative threshold given; calls accepted(k) for each one taken.
  template <class Accepted>
  void append_block(Eigen::Ref<Matrix> block, double threshold, Accepted accepted) {
    constexpr Index width = 32;  // columns handled by matrix products at once
    Vector c(capacity());
    Matrix C;
    for (Index first = 0; first < block.cols() && size_ < capacity(); first += width) {
      const Index columns = std::min(width, block.cols() - first), old = size_;
      auto part = block.middleCols(first, columns);
      const Eigen::RowVectorXd lengths = part.colwise().norm();
      C.noalias() = Q_.leftCols(old).transpose() * part;
      part.noalias() -= Q_.leftCols(old) * C;
      for (Index k = 0; k < columns && size_ < capacity(); ++k) {
        auto d = part.col(k);
        c.head(old) = C.col(k);
        const Index fresh = size_ - old;
        if (fresh > 0) {
          c.segment(old, fresh).noalias() = Q_.middleCols(old, fresh).transpose() * d;
          d.noalias() -= Q_.middleCols(old, fresh) * c.segment(old, fresh);
        }
        double rho = d.norm();
        if (rho < cancellation * lengths[k]) {  // as in `split`
          scratch_.head(size_).noalias() = Q().transpose() * d;
          d.noalias() -= Q() * scratch_.head(size_);
          c.head(size_) += scratch_.head(size_);
          rho = d.norm();
        }
        if (!(rho > threshold * lengths[k])) continue;
        append(c, d, rho);
        accepted(first + k);
      }
    }
  }

  /// Drops row j; the rows behind it move up.
  void remove(Index j) {
    for (Index k = j; k + 1 < size_; ++k) {
      R_.col(k).head(k + 2) = R_.col(k + 1).head(k + 2);
      lengths_[k] = lengths_[k + 1];
    }
    --size_;
    inverse_norm_ = 0;
    for (Index k = j; k < size_; ++k) {
      Eigen::JacobiRotation<double> rotation;
      rotation.makeGivens(R_(k, k), R_(k + 1, k), &R_(k, k));
      R_(k + 1, k) = 0;
      if (k + 1 < size_) R_.middleCols(k + 1, size_ - k - 1).applyOnTheLeft(k, k + 1, rotation.adjoint());
      Q_.applyOnTheRight(k, k + 1, rotation);
    }
  }

  /// x := R⁻¹x.
  void solve_upper(Eigen::Ref<Vector> x) const { solve_upper_triangle(R_.topLeftCorner(size_, size_), x); }
  /// x := R⁻ᵀx.
  void solve_lower(Eigen::Ref<Vector> x) const {
    if (size_ > 0) R_.topLeftCorner(size_, size_).triangularView<Eigen::Upper>().transpose().solveInPlace(x);
  }
  /// R⁻¹.
  Matrix inverse() const {
    Matrix columns = Matrix::Identity(size_, size_);
    if (size_ > 0) R_.topLeftCorner(size_, size_).triangularView<Eigen::Upper>().solveInPlace(columns);
    return columns;
  }
  /// An estimate of 1 / (smallest singular value of R with every column of length 1), so that no row's unit
  /// enters: one step of inverse iteration each way, from signs that let the first solution grow (Cline,
  /// Moler, Stewart and Wilkinson 1979).
  double inverse_norm() const {
    if (size_ == 0) return 0;
    if (inverse_norm_ > 0) return inverse_norm_;
    Vector x(size_);  // of the columns as they are: those of length 1, divided by the lengths
    double least = 1;
    for (Index j = 0; j < size_; ++j) {
      const double sum = R_.col(j).head(j).dot(x.head(j)) / lengths_[j];
      const double part = R_(j, j) / lengths_[j];
      x[j] = -(std::copysign(1, sum) + sum) / part;
      least = std::min(least, std::abs(part));
    }
    x /= x.norm();
    solve_upper(x);
    return inverse_norm_ = std::max(x.cwiseProduct(lengths_.head(size_)).norm(), 1 / least);
  }

 private:
  /// When less than this part of a vector is left after projection, the projection is repeated.
  static constexpr double cancellation = 0.5;

  Matrix Q_, R_;
  Vector scratch_, lengths_;
  Index size_ = 0;
  mutable double inverse_norm_ = 0;  // once asked for, until the rows change
};

}  // namespace convex::linear_algebra
