#pragma once

#include "convex/exact/integer.hpp"

namespace convex::inline exact_arithmetic {

/// Whether the symmetric integer matrix is positive definite, decided in integers: by a factor X of A⁻¹ found
/// in doubles, for which X A Xᵀ, computed without rounding, has a dominant positive diagonal (Gershgorin);
/// where that does not come out, by the signs of all leading minors (Bareiss 1968).
bool is_positive_definite(const IntegerRows& A);

}  // namespace convex::inline exact_arithmetic
