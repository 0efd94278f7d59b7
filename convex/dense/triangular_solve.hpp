#pragma once

#include "convex/vector.hpp"

namespace convex::inline dense {

/// X := T⁻¹X by columns of T, four at a time: for a few short right-hand sides this takes little more than
/// half the time of a solver that is blocked for large matrices, to which it leaves sizes beyond some dozens.
/// T: the lower (upper) triangle of an n×n matrix with a nonzero diagonal; nothing else of it is read. X:
/// n×k.
void solve_lower_triangle(Eigen::Ref<const Matrix> T, Eigen::Ref<Matrix> X);
void solve_upper_triangle(Eigen::Ref<const Matrix> T, Eigen::Ref<Vector> x);

}  // namespace convex::inline dense
