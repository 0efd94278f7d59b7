#pragma once

#include <array>
#include <vector>

#include "mechanics/liquid/field.hpp"

namespace mechanics::liquid {

/// A piece of the surface level = 0: its area (length, or 1), its middle and the unit normal away from level
/// < 0.
struct SurfacePiece {
  double area = 0;
  Point at{}, normal{};
};

/// The values of a level at the 2^d corners of a box cell, bit i of the index set where coordinate i is high.
/// Between them it is linear on Kuhn's simplices, whose faces agree between neighbouring cells, so that what
/// is cut out is a closed polyhedron.
struct CellLevels {
  std::size_t dimension = 1;
  Point low{}, step{};
  std::array<double, 8> at{};

  /// The part of the cell's volume where level < 0.
  double fraction() const;
  /// The same of the face where coordinate `axis` is high (`is_high`) or low.
  double face_fraction(std::size_t axis, bool is_high) const;
  std::vector<SurfacePiece> surface() const;
};

}  // namespace mechanics::liquid
