#pragma once

#include "convex/obstacle_problem/cut_grid.hpp"

namespace convex::inline obstacle_problem {

/// q on a grid, and who bounds it.
struct CutSolution {
  std::vector<double> q;           ///< with the frame
  std::vector<std::uint8_t> held;  ///< 1 where q = 0 by its bound
  std::vector<double> push;        ///< the multiplier there, >= 0
  std::vector<std::uint8_t> taut;  ///< by pendant: y = 0
  Index steps = 0;                 ///< V-cycles
  bool ended = false;              ///< the sets belong to q
};

/// Primal-dual active sets (Hintermüller, Ito and Kunisch 2003), which end after finitely many steps for
/// M-matrices, nested: on each of the grids from the coarsest, the last, to the finest, begun from the one
/// before. Each grid has the even points of the one before it in the list. The solutions by grid, finest
/// first. `one_sided` false: the equation without bounds. Without pull the load must not sum up to more than
/// 0 (or, without bounds, to anything else).
std::vector<CutSolution> solve_cut_grids(const std::vector<const CutGrid*>& grids, bool one_sided = true);

}  // namespace convex::inline obstacle_problem
