#pragma once

#include <vector>

#include "convex/obstacle_problem/cut_grid.hpp"
#include "mechanics/liquid/liquid_scene.hpp"

namespace mechanics::liquid {

/// A place of the boundary where the pressure is given, seen from the point `from` of a grid.
struct GivenPressure {
  convex::Index from = 0;
  Point at{};
  double pressure = 0;
  std::size_t part = 0;
};

/// A piece of a wall: the point of the grid that stands for it, and, where the wall is off that point, the
/// pendant that does.
struct WallPiece {
  convex::Index point = 0;
  std::ptrdiff_t pendant = -1;
  std::size_t part = 0;
  double area = 0, load = 0;  ///< load: ρ (F·n - a) over the piece
  Point at{};
};

/// A scene on a grid of nodes over the box of its domain. Second order and symmetric: where the pressure is
/// given, links cut at the boundary (Gibou, Fedkiw, Cheng and Kang 2002); at walls, volumes and faces of the
/// cells around the nodes cut by the wall (Purvis and Burkhalter 1979), also of nodes beyond it. A wall off
/// its node hangs on it as a pendant, by which it parts at its place.
struct CutCells {
  convex::CutGrid grid;
  Point low{}, step{};
  std::array<convex::Index, 3> first{};  ///< of a window: the place of its first node on the whole grid
  std::vector<double> volume;            ///< of the cell of each point, cut by walls
  std::vector<double> given;             ///< the pressure at fixed points that lie on the boundary, else NaN
  std::vector<GivenPressure> pressures;  ///< at cut links and fixed points
  std::vector<WallPiece> walls;
  std::vector<double> h;  ///< at unknowns
  double hidden = 0;      ///< what of h may hide between nodes, in p (CellMean)

  Point at(convex::Index k) const;
  /// Of a whole cell across an axis; the volume for any other number.
  double face_area(std::size_t axis) const;
  /// In the window.
  std::array<convex::Index, 3> place(convex::Index k) const;
};

/// A part of a grid: nodes first to first + points - 1 by axis.
struct Window {
  std::array<convex::Index, 3> first{}, points{1, 1, 1};
  /// What a window must have around a node, by axis, so that the node has the row that it has on the whole
  /// grid.
  static constexpr convex::Index margin = 6;
};

/// `cells`: by axis. Throws InvalidInput where a boundary point lies in no part.
CutCells cut_cells(const LiquidScene&, const std::array<convex::Index, 3>& cells);
/// Of this part of the grid only.
CutCells cut_cells(const LiquidScene&, const std::array<convex::Index, 3>& cells, const Window&);

}  // namespace mechanics::liquid
