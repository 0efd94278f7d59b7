#include "mechanics/liquid/largest_pressure.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/liquid/wall_corners.hpp"

namespace mechanics::liquid {
namespace {

using convex::CutPoint;
using convex::Index;

std::size_t slot_of(Index k) { return static_cast<std::size_t>(k); }

}  // namespace

LargestPressure largest_pressure(const LiquidScene& scene, const CutCells& cells,
                                 const std::function<double(Index)>& value) {
  LargestPressure largest;
  const auto offer = [&](double p, const Point& x) {
    if (p > largest.p) largest = {p, x};
  };
  const convex::CutGrid& grid = cells.grid;
  for (const GivenPressure& given : cells.pressures) offer(given.pressure, given.at);
  for (const auto& [x, y] : scene.domain.vertices) {
    const Point vertex{x, y, 0};
    const BoundaryPart* part = scene.part_at(vertex);
    if (part != nullptr && part->is_free) offer(scene.free_pressure(*part, vertex), vertex);
  }
  const std::vector<WallCorner> corners = wall_corners(scene, cells, value);
  for (const WallCorner& corner : corners) offer(corner.p, corner.at);
  // Beside a corner the place on a wall that a node tells of may lie beyond it.
  const auto is_at_corner = [&](const Point& x) {
    return std::any_of(corners.begin(), corners.end(), [&](const WallCorner& corner) {
      return std::abs(x[0] - corner.at[0]) < cells.step[0] && std::abs(x[1] - corner.at[1]) < cells.step[1];
    });
  };
  // Nodes beyond a wall stand for what their cells have of the domain; p there is none of the domain's.
  std::vector<bool> near_wall(slot_of(grid.size()));
  for (const WallPiece& wall : cells.walls) {
    near_wall[slot_of(wall.point)] = true;
    for (std::size_t axis = 0; axis < grid.dimension; ++axis)
      for (const Index beside : {wall.point - grid.stride(axis), wall.point + grid.stride(axis)})
        if (beside >= 0 && beside < grid.size()) near_wall[slot_of(beside)] = true;
    if (wall.pendant < 0 || is_at_corner(wall.at)) continue;
    // On the boundary itself, of which a piece is a chord, p has gone on by so much of the wall's flux.
    const convex::Pendant& pendant = grid.pendants[slot_of(wall.pendant)];
    const double behind = value(pendant.point), away = wall.area / pendant.conductance;
    if (!(behind + 2 * std::abs(pendant.shift) > largest.p)) continue;
    const Point foot = scene.domain.foot(wall.at);
    double square = 0;
    for (std::size_t i = 0; i < foot.size(); ++i) square += (foot[i] - wall.at[i]) * (foot[i] - wall.at[i]);
    const double beyond = std::copysign(std::sqrt(square), scene.domain.level(wall.at));
    if (beyond < away) offer(behind + pendant.shift * (1 - beyond / away), foot);
  }
  const auto is_inside = [&](Index k, const Point& x) {
    return !near_wall[slot_of(k)] || scene.domain.level(x) <= scene.domain.reach();
  };
  const double most_above = 1 + 0.25 * static_cast<double>(grid.dimension);  // a top above its node, p >= 0
  for (Index k = 0; k < grid.size(); ++k) {
    if (grid.kind[slot_of(k)] != CutPoint::bounded) continue;
    const double here = value(k);
    if (!(most_above * here > largest.p)) continue;
    const Point node = cells.at(k);
    if (is_inside(k, node)) offer(here, node);
    Point x = node;
    double p = here;
    for (std::size_t axis = 0; axis < grid.dimension; ++axis) {
      const Index s = grid.stride(axis);
      if (grid.kind[slot_of(k - s)] != CutPoint::bounded || grid.kind[slot_of(k + s)] != CutPoint::bounded)
        continue;
      const double low = value(k - s), high = value(k + s);
      const double bend = low - 2 * here + high, tilt = 0.5 * (high - low);
      if (!(low <= here && high <= here && bend < 0)) continue;
      p -= 0.5 * tilt * tilt / bend;
      x[axis] -= tilt / bend * cells.step[axis];
    }
    if (x != node && is_inside(k, x)) offer(p, x);
  }
  return largest;
}

}  // namespace mechanics::liquid
