#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "mechanics/liquid/liquid_scene.hpp"
#include "mechanics/liquid/simplex_cut.hpp"

namespace mechanics::liquid {

/// What walls leave of a cell of a grid: its volume, the open parts of its faces, the pieces of walls in it.
/// Free parts do not count: where walls meet them, they are continued straight.
struct WallCut {
  struct Piece {
    SurfacePiece surface;
    const BoundaryPart* wall = nullptr;
  };
  double fraction = 1;                                ///< of the cell's volume
  std::array<double, 3> low{1, 1, 1}, high{1, 1, 1};  ///< open parts of the faces, by axis
  std::vector<Piece> pieces;
  bool has_free = false;  ///< a free part may be in the cell too
};

/// Cuts cells at the walls of a scene: exactly at polygons, else as linear between corners.
class WallLevel {
 public:
  explicit WallLevel(const LiquidScene&);
  /// None when no wall is near the cell low..low + step.
  std::optional<WallCut> cut(const Point& low, const Point& step) const;
  bool is_beyond_wall(const Point&) const;

 private:
  /// A smooth part of the boundary: its own level, and where on it a point is nearest to.
  struct Sheet {
    std::function<double(const Point&)> level;
    std::function<Point(const Point&)> nearest;
  };
  struct Near {
    const Sheet* sheet;
    const BoundaryPart* wall;
  };
  const BoundaryPart* part_near(const Point&) const;
  std::optional<WallCut> cut_polygon(const Point& low, const Point& step) const;
  const LiquidScene& scene_;
  std::vector<Sheet> sheets_;
};

}  // namespace mechanics::liquid
