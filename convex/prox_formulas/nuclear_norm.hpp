#pragma once

#include "convex/vector.hpp"

/// The nuclear norm, the sum of the singular values, of matrices with the product Σ X_ij Y_ij.
namespace convex::prox_formulas {

/// Prox of weight times the nuclear norm: singular values lessened by `weight`, at least 0 (Cai, Candès and
/// Shen 2010), with its derivative (Yang 2009). Z = U diag(sigma) Vᵀ, thin, k = min(rows, cols).
struct NuclearNormProx {
  Matrix X, U, V;
  Vector sigma;  ///< k, decreasing
  double weight = 0;

  /// The derivative at H: U(S∘sym(M) + T∘skew(M))Vᵀ + (H - U Uᵀ H)V diag(r)Vᵀ + U diag(r) Uᵀ(H - H V Vᵀ),
  /// M = UᵀHV, with divided differences S, divided sums T and ratios r = phi/sigma.
  Matrix derivative(const Matrix& H) const;
  /// The derivative for stacked matrices.
  Matrix jacobian() const;
};

/// InvalidInput when the weight is negative or not a number.
NuclearNormProx nuclear_norm_prox(const Matrix& Z, double weight = 1);

/// Nearest matrix with largest singular value at most `radius`, the unit ball of the dual norm scaled.
Matrix proj_spectral_ball(const Matrix& Z, double radius = 1);

/// The prox on a matrix of `rows` rows stacked by columns; InvalidInput when they do not fill it.
Vector prox_nuclear_norm(const Vector& z, double weight, Index rows);

}  // namespace convex::prox_formulas
