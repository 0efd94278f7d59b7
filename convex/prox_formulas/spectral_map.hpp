#pragma once

#include <functional>

#include "convex/vector.hpp"

/// Maps of matrices that act on their singular values, or on the eigenvalues of their symmetric part, by a
/// map phi of vectors that goes with every permutation (and, for singular values, every change of sign).
namespace convex::prox_formulas {

using VectorMap = std::function<Vector(const Vector&)>;
using VectorJacobian = std::function<Matrix(const Vector&)>;

/// U diag(phi(sigma)) Vᵀ of Z = U diag(sigma) Vᵀ.
Matrix map_of_singular_values(const Matrix& Z, const VectorMap& phi);
/// Its derivative for stacked matrices (Lewis and Sendov 2005): J_phi on the diagonal of UᵀHV, divided
/// differences of phi on its symmetric part and divided sums on its skew part.
Matrix jacobian_of_singular_values(const Matrix& Z, const VectorMap& phi, const VectorJacobian& J_phi);

/// V diag(phi(lambda)) Vᵀ of the symmetric part V diag(lambda) Vᵀ of Z, and its derivative for stacked
/// matrices (Lewis and Sendov 2001).
Matrix map_of_eigenvalues(const Matrix& Z, const VectorMap& phi);
Matrix jacobian_of_eigenvalues(const Matrix& Z, const VectorMap& phi, const VectorJacobian& J_phi);

}  // namespace convex::prox_formulas
