#pragma once

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// A⁻¹ by elimination with row pivots, A n×n. Of a singular A it is not finite, or far off.
Matrix inverse(const Matrix& A);

}  // namespace convex::linear_algebra
