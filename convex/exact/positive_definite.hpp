#pragma once

#include <optional>

#include "convex/exact/integer.hpp"
#include "convex/vector.hpp"

namespace convex::inline exact_arithmetic {

/// Whether the symmetric integer matrix is positive definite, decided in integers: by a factor X of A⁻¹ found
/// in doubles, for which X A Xᵀ, computed without rounding, has a dominant positive diagonal (Gershgorin);
/// where that does not come out, by the signs of all leading minors (Bareiss 1968).
bool is_positive_definite(const IntegerRows& A);

/// The factor L of the symmetric integer matrix A = L Lᵀ, lower, its entries rounded from their exact values:
/// by Bareiss' elimination l_ik = a_ik / sqrt(d_k d_(k-1)), a_ik the entries left after k - 1 steps, d_k the
/// leading minors. However nearly singular A is. None where A is not positive definite, or where that would
/// take more than `most` word operations (`cholesky_work`).
std::optional<Matrix> cholesky_factor(const IntegerRows& A, double most);
/// An estimate beforehand, from the largest number of bits of an entry of an n×n matrix.
double cholesky_work(Index n, std::size_t bits);

}  // namespace convex::inline exact_arithmetic
