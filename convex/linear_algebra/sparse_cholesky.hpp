#pragma once

#include <memory>

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// P W Pᵀ = L Lᵀ of a sparse symmetric W, n×n, of which the lower triangle is read; P is of approximately
/// minimum degree (Amestoy, Davis and Duff 1996). Eigen's SimplicialLLT.
class SparseCholesky {
 public:
  explicit SparseCholesky(const SparseMatrix& W);
  SparseCholesky(SparseCholesky&&) noexcept;
  ~SparseCholesky();

  /// Whether every pivot was positive. The rest may be asked for only then.
  bool is_definite() const;
  SparseMatrix L() const;
  /// That of L.
  Vector diagonal() const;
  /// PX, Px and Pᵀx.
  Matrix permuted_columns(const Matrix& X) const;
  Vector permuted(const Vector& x) const;
  Vector permuted_back(const Vector& x) const;
  /// Lᵀx.
  Vector times_upper(const Vector& x) const;
  /// X := L⁻¹X.
  void solve_lower_in_place(Matrix& X) const;
  /// x := L⁻ᵀx.
  void solve_upper_in_place(Vector& x) const;
  /// W⁻¹b.
  Vector solve(const Vector& b) const;

 private:
  struct Factor;
  std::unique_ptr<const Factor> factor_;
};

/// P K Pᵀ = L D Lᵀ of a sparse symmetric K that need not be definite, but quasi-definite: [H, Uᵀ; U, -G] with
/// H and G positive definite has such a factor for every P (Vanderbei 1995). Eigen's SimplicialLDLT.
class SparseLdlt {
 public:
  SparseLdlt();
  ~SparseLdlt();

  /// Reads the lower triangle of K; false when a pivot was 0.
  bool factor(const SparseMatrix& K);
  /// K⁻¹b.
  Vector solve(const Vector& b) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace convex::linear_algebra
