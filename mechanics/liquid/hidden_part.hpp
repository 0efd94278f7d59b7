#pragma once

#include <optional>

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// A point of the boundary in a part that the grid does not see there: a piece of it that is narrower than
/// the cells. By intervals on pieces of the boundary's cells, halved until they show that no such part is
/// there; what is as small as a millionth of a cell (a 256th in space) may be missed.
struct HiddenPart {
  const BoundaryPart* part;
  Point at;
};
std::optional<HiddenPart> hidden_part(const LiquidScene&, const CutCells&);

}  // namespace mechanics::liquid
