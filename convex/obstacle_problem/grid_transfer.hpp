#pragma once

#include "convex/obstacle_problem/grid_multigrid.hpp"

namespace convex::inline obstacle_problem {

/// Fields with frames between a grid and the one of its odd points: bilinear interpolation, points off the
/// grids counting as 0, and its transpose.
void interpolate(const GridOperator& coarse, const Vector& from, const GridOperator& fine, Vector& to);
void restrict_to(const GridOperator& fine, const Vector& from, const GridOperator& coarse, Vector& to);

}  // namespace convex::inline obstacle_problem
