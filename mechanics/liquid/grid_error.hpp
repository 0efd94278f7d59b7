#pragma once

#include <functional>

#include "mechanics/liquid/grid_scene.hpp"

namespace mechanics::liquid {

/// An estimate of |p - p*| in the largest norm on the finest grid, the discretisation included, from the
/// solutions on all of them; infinite of one grid alone. `largest`: p.
///
/// Of the smooth part: differences of grids at common nodes, whose ratio tells the order, between what theory
/// allows, beside junctions above the first only where two ratios show it; the error left by it, doubled.
/// Differences may be small by chance, so that those before, lowered by that order, count too. At junctions
/// of free parts and walls, and at corners, p has a term K r^α
/// (Grisvard 1985, section 4.4: α = π/ω, and π/(2ω) where a wall meets a free part), of which a grid misses a
/// part of K h^α whatever others say: there the largest second difference of nodes next to each other, which
/// is O(h²) where p is smooth and of the size of K h^α where it is not, is added. What p bends beside given
/// pressures, which nodes in a cavity alone do not see, counts where it is larger than all that.
///
/// A cavity ends at a node for the grid. Where it ends by d further on, which may be half a step s, and the
/// same in all nested grids, all of them are |h| d²/2 off, and no difference tells: |h| s²/8 is added.
///
/// `differences`: of p on each grid and the next coarser one, finest first.
double error_by_differences(const LiquidScene&, const std::vector<double>& differences, long cells);
/// What second differences say, at junctions and corners and beside given pressures, and h at the edge of a
/// cavity.
struct Bends {
  double singular = 0, beside = 0, edge = 0;
};
/// `value`: p at a node, NaN where it is none or not known.
Bends largest_bends(const LiquidScene&, const CutCells&, long cells,
                    const std::function<double(convex::Index)>& value);
double error_by(double differences, const Bends&);
/// All of it.
double estimated_grid_error(const LiquidScene&, const GridLevels&, const std::vector<convex::CutSolution>&,
                            double largest);

}  // namespace mechanics::liquid
