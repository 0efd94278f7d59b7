#pragma once

#include <functional>
#include <vector>

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// Where two walls meet at an inner angle below π, at a vertex of a polygon or where two inequalities in two
/// coordinates are equalities, and p there.
struct WallCorner {
  Point at{};
  double p = 0;
  std::array<const BoundaryPart*, 2> walls{};
  std::array<double, 2> flux{};  ///< ρ (F·n - a) of each
};

/// They lie between nodes. What both walls ask for is the gradient of p there, by which p goes on from a node
/// behind the corner: to second order in the step at right and acute angles, to the order π/ω at an obtuse ω.
/// `value`: p at a node, NaN where it is none or not known; a corner without a node behind it is left out.
std::vector<WallCorner> wall_corners(const LiquidScene&, const CutCells&,
                                     const std::function<double(convex::Index)>& value);

}  // namespace mechanics::liquid
