#pragma once

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// By how much the pressure given leaves those at crossings around, and p with it at the most (p is monotone
/// in what is given), where that is more than a hundredth of `scale`: a bump between crossings. By intervals
/// on the pieces of cells through which the boundary goes, halved until they tell.
double hidden_pressure(const LiquidScene&, const CutCells&, double scale);

}  // namespace mechanics::liquid
