#pragma once

#include "mechanics/liquid/liquid_scene.hpp"

namespace mechanics::liquid {

/// A rectangle of the side of a box around `middle`; `extent` is 0 across the side.
struct SidePiece {
  Point middle{}, extent{}, normal{};
};

/// ρ (F·n - a) by area of a piece whose middle lies on this wall: its value at the node, which is exact for
/// quadratic p. Where a wall of another name, or another branch of an expression, begins on the piece: the
/// mean, each part with its own; what a free part has of it is `wall`'s.
double side_flux(const LiquidScene&, const BoundaryPart& wall, const SidePiece&, const Point& node);

}  // namespace mechanics::liquid
