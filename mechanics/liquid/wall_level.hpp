#pragma once

#include "mechanics/liquid/liquid_scene.hpp"
#include "mechanics/liquid/simplex_cut.hpp"

namespace mechanics::liquid {

/// The boundary as walls alone see it: below 0 inside and beyond free parts, above 0 beyond walls. Where
/// walls meet free parts they are continued straight.
class WallLevel {
 public:
  explicit WallLevel(const LiquidScene&);
  /// The values at the corners of the cell. False when no wall is near.
  bool fill(CellLevels&) const;
  bool is_beyond_wall(const Point&) const;
  /// The wall at a point of its surface, null where it was continued beyond a free part.
  const BoundaryPart* wall_at(const Point&) const;

 private:
  /// A smooth part of the boundary: its own level, and where on it a point is nearest to.
  struct Sheet {
    std::function<double(const Point&)> level;
    std::function<Point(const Point&)> nearest;
  };
  const BoundaryPart* part_near(const Point&) const;
  const LiquidScene& scene_;
  std::vector<Sheet> sheets_;
};

}  // namespace mechanics::liquid
