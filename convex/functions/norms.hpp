#pragma once

#include "convex/gamma0/function.hpp"

/// Norms and other support functions, of plain coordinates. weight >= 0; 0 gives the function 0.
namespace convex::inline named_functions {

/// weight |x|₂, the support function of ball2(weight).
Function norm2(double weight = 1);
/// weight max |x_i|, that of ball1(weight).
Function norm_inf(double weight = 1);
/// max x_i, that of simplex(1).
Function max();
/// The sum of the k largest entries, that of capped_simplex(k, 1); k = 1, 2, …, n.
Function sum_largest(double k);
/// max_i a_i·x + b_i over the rows of A: m×n, b: m.
Function max_affine(const Matrix& A, const Vector& b);
/// weight Σ |x_(i+1) - x_i|, that of bounded_partial_sums(weight).
Function total_variation(double weight = 1);
/// weight Σ_k |x over group k|₂ over consecutive groups, as group_ball (Yuan and Lin 2006).
Function group_norm(double weight, Index size);
Function group_norm(double weight, const std::vector<Index>& sizes);
/// weight Σ singular values of a matrix of so many rows stacked by columns.
Function nuclear_norm(double weight, Index rows);
/// Σ w_i |x|_(i), |x|_(1) >= |x|_(2) >= …, with weights w_1 >= w_2 >= … >= 0 (Bogdan et al. 2015).
Function sorted_norm1(const Vector& weights);
/// -log det X for a symmetric positive definite X stacked by columns, else +inf.
Function neg_log_det();

}  // namespace convex::inline named_functions
