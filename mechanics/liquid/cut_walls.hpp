#pragma once

#include <cstdint>
#include <vector>

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// Where a node of a grid is: in the domain, on its boundary, or outside.
enum class Side : std::uint8_t { inside, on, outside };

/// Takes out the cells beyond walls that nothing of the liquid's side reaches, and gives each piece of a wall
/// its load and, where the node behind it is off the wall, its pendant. normals: of the pieces, of which some
/// may go.
void hang_walls(CutCells&, const std::vector<Side>&, std::vector<Point>& normals);

}  // namespace mechanics::liquid
