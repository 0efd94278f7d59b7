#pragma once

#include <optional>

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// A point outside of a domain by inequalities, in a cell around which all nodes are inside: of a hole, or a
/// gap, between the nodes. Boxes in which the range of the level is below 0 are passed by, others are halved;
/// what is as small as a 1024th of a cell may be missed. Of a polygon a channel or a notch that is narrower
/// than the diagonal of a cell.
std::optional<Point> hidden_hole(const Domain&, const CutCells&);

}  // namespace mechanics::liquid
