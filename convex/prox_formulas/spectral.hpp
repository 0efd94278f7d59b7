#pragma once

#include "convex/vector.hpp"

/// Functions of the eigenvalues of a symmetric matrix, among all n×n matrices with the product Σ X_ij Y_ij:
/// +inf where X is not symmetric. So the prox at Z is that at its symmetric part S = ½(Z + Zᵀ), it acts on
/// the eigenvalues (Lewis 1996), and the polar of a cone of symmetric matrices holds every skew matrix. A
/// vector of n² entries is the matrix stacked by columns; InvalidInput when its size is no square.
namespace convex::prox_formulas {

/// A prox of a spectral function with its derivative in the manner of Lewis and Sendov (2001):
/// H -> V (divided ∘ (Vᵀ sym(H) V)) Vᵀ.
struct SpectralProx {
  Matrix X;        ///< the point, symmetric
  Matrix V;        ///< eigenvectors of S as columns
  Vector lambda;   ///< eigenvalues of S, increasing
  Matrix divided;  ///< (phi_i - phi_j)/(lambda_i - lambda_j), phi = prox of lambda; phi' where they are equal

  /// The derivative at H: n×n.
  Matrix derivative(const Matrix& H) const;
  /// The derivative as a matrix of n²×n² for stacked matrices, symmetric.
  Matrix jacobian() const;
};

/// Nearest symmetric positive semidefinite matrix (Higham 1988).
SpectralProx psd_projection(const Matrix& Z);
/// Prox of -weight log det X, weight > 0: eigenvalues ½(lambda + sqrt(lambda² + 4 weight)).
SpectralProx log_det_prox(const Matrix& Z, double weight = 1);

/// The same on stacked matrices.
Vector proj_psd_cone(const Vector& z);
Vector prox_log_det(const Vector& z, double weight = 1);
/// Nearest point of the polar of the psd cone: the skew part of Z and the negative part of S.
Vector proj_psd_polar(const Vector& z);

/// sqrt of the size, for a vector that stacks a square matrix.
Index order_of_stacked(const Vector& z);

}  // namespace convex::prox_formulas
