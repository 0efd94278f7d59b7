#pragma once

#include "convex/gamma0/function.hpp"

/// Norms and support functions of matrices stacked by columns. weight, radius, total >= 0; rows >= 1, or 0
/// for a square matrix.
namespace convex::inline named_functions {

/// weight (Σ sigma_i^p)^(1/p) over the singular values, 1 <= p <= inf: p = 1 is the nuclear norm, 2 the
/// Frobenius norm, inf the largest singular value. The support function of schatten_ball of the dual
/// exponent.
Function schatten(double p, Index rows = 0, double weight = 1);
/// {X : (Σ sigma_i^p)^(1/p) <= radius}.
Set schatten_ball(double p, Index rows = 0, double radius = 1);

/// weight times the largest eigenvalue of a symmetric X, +inf on other matrices: the support function of
/// spectraplex(weight).
Function max_eigenvalue(double weight = 1);
/// {X : ½(X + Xᵀ) is positive semidefinite with the trace `total`}.
Set spectraplex(double total = 1);

}  // namespace convex::inline named_functions
