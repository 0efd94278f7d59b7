#pragma once

#include <memory>
#include <mutex>

#include "convex/linear_algebra/sparse_cholesky.hpp"
#include "convex/vector.hpp"

namespace convex {

/// The rounding of pivots may be far larger than that of the entries: beside those below this part of their
/// diagonal entries the least eigenvalue of D^-½ W D^-½ is looked at, D the diagonal of W.
inline constexpr double plain_pivot = 0x1p-26;

/// A sparse Gram matrix W, W = F Fᵀ with F = PᵀL, P a fill-reducing permutation. Where the entries prove that
/// no pivot can be small (`is_plainly_definite`), F is made when it is first asked for, by one thread while
/// others wait; else at once. Which of both depends on W alone, and so do all results.
class SparseGram {
 public:
  /// What a pivot must be at least, relative to its diagonal entry, for W to count as positive definite.
  /// Throws InvalidInput otherwise. W: symmetric, its diagonal positive.
  SparseGram(SparseMatrix&& W, double least_pivot);

  const SparseMatrix& matrix() const { return W_; }
  /// ||x||_W; without F when W is plainly definite.
  double norm(const Vector& x) const;
  void whiten_in_place(Eigen::Ref<Matrix> C) const;
  void unwhiten_in_place(Eigen::Ref<Vector> w) const;
  double factor_condition() const;

 private:
  struct Factor {
    linear_algebra::SparseCholesky LLT;
    double condition;
  };
  const Factor& factor() const;

  SparseMatrix W_;
  double least_pivot_;
  Vector excess_;  ///< of the diagonal over the other entries of a row; empty unless W is plainly definite
  mutable std::once_flag made_;
  mutable std::unique_ptr<const Factor> factor_;
};

/// The excess w_ii - Σ_j≠i |w_ij| of every row where it proves, by O(nonzeros) operations, that every pivot
/// of every symmetric elimination exceeds `least_pivot` w_ii; else nothing. Then no excess is negative, W is
/// the matrix of a network of conductances |w_ij| with excess to the ground (up to signs, which only help),
/// and a pivot is at least one over the resistance from its node to the ground along any path (Rayleigh's
/// monotonicity: Doyle and Snell 1984).
Vector excess_if_plainly_definite(const SparseMatrix& W, double least_pivot);

/// Whether every entry above the diagonal has its like below it, not one bit off, all of them finite: then W
/// is its own mean with its transpose, which is not made.
bool is_exactly_symmetric(const SparseMatrix& W);

}  // namespace convex
