#pragma once

#include <vector>

#include "convex/vector.hpp"

namespace convex::inline multiplier_sets {

/// The shortest lambda with E'lambda = E'start, E = (I; T'), and lambda_j >= 0 where not `is_free`, in place
/// of `start`; T: k×d, start: k + d. For d >> k: lambda = (Ey)⁺, the ⁺ on signed entries, where the y of k
/// entries minimises ½|(Ey)⁺|² - y·E'start, by Newton's method for piecewise quadratics (Mangasarian 2002, "A
/// finite Newton method for classification"). False where rounding keeps its gradient from becoming 0.
bool least_norm_by_newton(const Matrix& T, const std::vector<bool>& is_free, Vector& start);

}  // namespace convex::inline multiplier_sets
