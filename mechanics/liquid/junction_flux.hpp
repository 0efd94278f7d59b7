#pragma once

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// Where a wall ends at a free part, the open faces of a node's cell and its pieces of walls do not close it.
/// Through what does flows a·∇p, a its vector area, and data tell ∇p there: the wall n·∇p = ρ (F·n - a), the
/// pressures given around, by least squares, what is left of it. With this load the equations of these
/// nodes hold for every linear p, so that errors are O(h²) where p is smooth. The matrix stays as it is.
///
/// open: by node, the sum of outward areas of its faces to given pressures; normals: of the pieces of walls.
void close_junctions(const LiquidScene&, CutCells&, std::vector<Point> open,
                     const std::vector<Point>& normals);

}  // namespace mechanics::liquid
