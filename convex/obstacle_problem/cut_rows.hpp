#pragma once

#include "convex/obstacle_problem/cut_grid.hpp"

namespace convex::inline obstacle_problem {

/// Calls row(first, j, k) for every row along the first axis, `first` its point 0.
template <class Row>
void for_rows(const CutGrid& grid, Row row) {
  for (Index k = 0; k < grid.points[2]; ++k)
    for (Index j = 0; j < grid.points[1]; ++j) row(grid.at(0, j, k), j, k);
}

/// A row of a plane grid, a plane of one in space.
inline Index slabs(const CutGrid& grid) { return grid.dimension == 3 ? grid.points[2] : grid.points[1]; }

/// Calls row(first, j, k) for the rows of a slab; of none outside of the grid.
template <class Row>
void for_slab(const CutGrid& grid, Index slab, Row row) {
  if (slab < 0 || slab >= slabs(grid)) return;
  if (grid.dimension < 3) return row(grid.at(0, slab, 0), slab, 0);
  for (Index j = 0; j < grid.points[1]; ++j) row(grid.at(0, j, slab), j, slab);
}

}  // namespace convex::inline obstacle_problem
