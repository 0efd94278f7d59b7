#pragma once

#include <functional>
#include <limits>

#include "convex/double_double.hpp"
#include "convex/obstacle_problem/grid_multigrid.hpp"

namespace convex::inline obstacle_problem {

inline constexpr double no_bound = -std::numeric_limits<double>::infinity();

/// An obstacle problem on one grid, fields with frames: minimise ½ q·Aq - z·q over q >= lower, which is -inf
/// where there is no bound, with q = lower on the points `held`: 1 there, else 0; empty when none is.
struct ObstacleGrid {
  GridOperator A;
  Vector z, lower, held = Vector();
  bool holds(Index k) const { return held.size() > 0 && held[k] > 0; }
};

/// q = hi + lo and z - Aq; `missing` bounds what it lacks in the norm of A as far as the shrinking of
/// corrections tells.
struct ObstaclePoint {
  DoubleDoubleVector q;
  Vector rest;
  double missing = 0;
  Index steps = 0;     ///< V-cycles, on all grids
  bool ended = false;  ///< the active set belongs to q, with all digits
};

/// rest := z - Au at the points of the grid, both pairs, rounded once.
void precise_residual(const GridOperator& A, const DoubleDoubleVector& z, const DoubleDoubleVector& u,
                      Vector& rest);

/// Primal-dual active sets (Hintermüller, Ito and Kunisch 2003), which end after finitely many steps for
/// M-matrices, nested from a grid of 8 points to the one given, after projected sweeps that bring the set
/// close; refined with residuals in twice the working precision, after which the signs are checked again.
/// multigrid: of its operator; the free points of the answer are set in it then.
/// told: hears after each set how many V-cycles were taken.
ObstaclePoint solve_obstacle_grid(const ObstacleGrid&, GridMultigrid& multigrid,
                                  const std::function<void(Index)>& told);

}  // namespace convex::inline obstacle_problem
