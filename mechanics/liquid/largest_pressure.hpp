#pragma once

#include <functional>

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

struct LargestPressure {
  double p = -1;
  Point at{};
};

/// Of p on the closed domain, as a grid tells it: at its nodes there, with the tops of the parabolas through
/// them, at pieces of walls and corners of them, at the pressures given where links are cut and at the
/// vertices of a polygon.
/// `value`: p at a node, NaN where it is none or not known.
LargestPressure largest_pressure(const LiquidScene&, const CutCells&,
                                 const std::function<double(convex::Index)>& value);

}  // namespace mechanics::liquid
