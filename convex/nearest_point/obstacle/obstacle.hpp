#pragma once

#include <optional>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline obstacle {

/// An obstacle problem on a grid: A the 5-point Laplacian on width×height points, d on the diagonal and -c
/// beside it, d >= 4c > 0, coordinates row by row; each row of U bounds one coordinate from below or,
/// two-sided, holds it, each coordinate at most once. The primal-dual active set (Hintermüller, Ito and
/// Kunisch 2003), which for such A ends after finitely many steps from any start, nested from coarse grids to
/// fine; its systems by conjugate gradients with a multigrid cycle, refined in twice the working precision.
/// None when the problem is not of this kind, or the steps did not end. The data are checked.
std::optional<Solution> solve_obstacle(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline obstacle
