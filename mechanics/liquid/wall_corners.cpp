#include "mechanics/liquid/wall_corners.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mechanics::liquid {
namespace {

using convex::CutPoint;
using convex::Index;
using Vertex = std::array<double, 2>;

/// Nodes behind a corner are looked for within so many steps.
constexpr Index steps_around = 4;

/// Walls at a smaller sine of their angle are nearly one line, or a needle: they tell no gradient.
constexpr double least_sine = 0.05;

Vertex outward_normal(const Vertex& from, const Vertex& to) {
  const double x = to[0] - from[0], y = to[1] - from[1], length = std::hypot(x, y);
  return {y / length, -x / length};
}

/// The wall of an edge beside its end, or nothing.
const BoundaryPart* wall_beside(const LiquidScene& scene, const Vertex& end, const Vertex& other) {
  constexpr double part = 1e-6;
  const BoundaryPart* found =
      scene.part_at({end[0] + part * (other[0] - end[0]), end[1] + part * (other[1] - end[1]), 0});
  return found == nullptr || found->is_free ? nullptr : found;
}

}  // namespace

std::vector<WallCorner> wall_corners(const LiquidScene& scene, const CutCells& cells,
                                     const std::function<double(Index)>& value) {
  std::vector<WallCorner> found;
  const std::vector<Vertex>& vertices = scene.domain.vertices;
  const convex::CutGrid& grid = cells.grid;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Vertex &before = vertices[(k + vertices.size() - 1) % vertices.size()], &here = vertices[k],
                 &after = vertices[(k + 1) % vertices.size()];
    const Vertex m = outward_normal(before, here), n = outward_normal(here, after);
    const double sine = m[0] * n[1] - m[1] * n[0];
    if (!(sine > least_sine)) continue;
    WallCorner corner{
        {here[0], here[1], 0}, 0, {wall_beside(scene, here, before), wall_beside(scene, here, after)}, {}};
    if (corner.walls[0] == nullptr || corner.walls[1] == nullptr) continue;
    corner.flux = {scene.wall_flux(*corner.walls[0], corner.at, {m[0], m[1], 0}),
                   scene.wall_flux(*corner.walls[1], corner.at, {n[0], n[1], 0})};
    std::array<Index, 2> middle{};
    for (std::size_t i = 0; i < 2; ++i)
      middle[i] = std::lround((corner.at[i] - cells.low[i]) / cells.step[i]) - cells.first[i];
    double nearest = std::numeric_limits<double>::infinity();
    for (Index b = std::max<Index>(0, middle[1] - steps_around);
         b <= std::min(grid.points[1] - 1, middle[1] + steps_around); ++b)
      for (Index a = std::max<Index>(0, middle[0] - steps_around);
           a <= std::min(grid.points[0] - 1, middle[0] + steps_around); ++a) {
        const Index node = grid.at(a, b, 0);
        if (grid.kind[static_cast<std::size_t>(node)] != CutPoint::bounded) continue;
        const Point from = cells.at(node);
        // The way to the corner, as α m + β n with α, β >= 0: so p there grows with both fluxes.
        const double x = corner.at[0] - from[0], y = corner.at[1] - from[1];
        const double alpha = (x * n[1] - y * n[0]) / sine, beta = (m[0] * y - m[1] * x) / sine;
        const double far = std::hypot(x / cells.step[0], y / cells.step[1]), p = value(node);
        if (!(alpha >= 0 && beta >= 0 && far < nearest) || std::isnan(p)) continue;
        if (scene.domain.level(from) > scene.domain.reach()) continue;
        nearest = far;
        corner.p = p + alpha * corner.flux[0] + beta * corner.flux[1];
      }
    if (std::isfinite(nearest)) found.push_back(corner);
  }
  return found;
}

}  // namespace mechanics::liquid
