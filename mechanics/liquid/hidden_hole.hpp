#pragma once

#include <optional>

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// A point outside of a domain by inequalities, in a cell around which all nodes are inside: of a hole, or a
/// gap, between the nodes. Boxes in which the range of the level is below 0 are passed by, others are halved;
/// what is as small as a 1024th of a cell may be missed. Or a node, where most that are inside have a
/// neighbour outside on both sides: of a domain as thin as a cell. Of a polygon a strip, a channel or a notch
/// so narrow.
std::optional<Point> hidden_hole(const Domain&, const CutCells&);

}  // namespace mechanics::liquid
