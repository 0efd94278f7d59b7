#include "mechanics/liquid/wall_corners.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

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

/// A corner with the outward normals on both sides of it, n counterclockwise from m, and points that its
/// walls lead to.
struct Corner {
  Vertex here, m, n, along_m, along_n;
  double sine() const { return m[0] * n[1] - m[1] * n[0]; }
};

std::vector<Corner> corners_of_polygon(const std::vector<Vertex>& vertices) {
  std::vector<Corner> found;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Vertex &before = vertices[(k + vertices.size() - 1) % vertices.size()], &here = vertices[k],
                 &after = vertices[(k + 1) % vertices.size()];
    found.push_back({here, outward_normal(before, here), outward_normal(here, after), before, after});
  }
  return found;
}

Vertex gradient(const std::function<double(const Point&)>& level, const Vertex& x, double width) {
  return {(level({x[0] + width, x[1], 0}) - level({x[0] - width, x[1], 0})) / (2 * width),
          (level({x[0], x[1] + width, 0}) - level({x[0], x[1] - width, 0})) / (2 * width)};
}

/// Where two inequalities are equalities, beside a wall, by Newton's method from there.
std::optional<Corner> corner_of_sheets(const Domain& domain, std::size_t i, std::size_t j, Vertex x,
                                       double step) {
  constexpr int most_steps = 20;
  const double width = 1e-6 * domain.longest();
  const auto &f = domain.sheets[i], &g = domain.sheets[j];
  const Vertex start = x;
  for (int k = 0; k < most_steps; ++k) {
    const Vertex u = gradient(f, x, width), v = gradient(g, x, width);
    const double det = u[0] * v[1] - u[1] * v[0], a = f({x[0], x[1], 0}), b = g({x[0], x[1], 0});
    const double length_u = std::hypot(u[0], u[1]), length_v = std::hypot(v[0], v[1]);
    if (!(std::abs(det) > least_sine * length_u * length_v)) return std::nullopt;
    const Vertex move{-(a * v[1] - b * u[1]) / det, -(u[0] * b - v[0] * a) / det};
    x = {x[0] + move[0], x[1] + move[1]};
    if (!(std::hypot(x[0] - start[0], x[1] - start[1]) < 2 * step)) return std::nullopt;
    if (std::hypot(move[0], move[1]) > 0.1 * domain.reach()) continue;
    Corner corner{x, {u[0] / length_u, u[1] / length_u}, {v[0] / length_v, v[1] / length_v}, {}, {}};
    if (corner.sine() < 0) std::swap(corner.m, corner.n);
    // Of a wall with the normal m, the way on which the other level falls.
    const Vertex &m = corner.m, &n = corner.n;
    corner.along_m = {x[0] + domain.longest() * m[1], x[1] - domain.longest() * m[0]};
    corner.along_n = {x[0] - domain.longest() * n[1], x[1] + domain.longest() * n[0]};
    return corner;
  }
  return std::nullopt;
}

std::vector<Corner> corners_of_sheets(const Domain& domain, const CutCells& cells) {
  std::vector<Corner> found;
  if (domain.dimension != 2) return found;
  const double step = std::hypot(cells.step[0], cells.step[1]);
  const auto is_there = [&](const Corner& corner) {
    return std::any_of(found.begin(), found.end(), [&](const Corner& other) {
      return std::hypot(other.here[0] - corner.here[0], other.here[1] - corner.here[1]) < 0.1 * step;
    });
  };
  for (std::size_t i = 0; i < domain.sheets.size(); ++i)
    for (std::size_t j = i + 1; j < domain.sheets.size(); ++j)
      for (const WallPiece& wall : cells.walls) {
        const auto corner = corner_of_sheets(domain, i, j, {wall.at[0], wall.at[1]}, step);
        if (corner && domain.level({corner->here[0], corner->here[1], 0}) <= domain.reach() &&
            !is_there(*corner))
          found.push_back(*corner);
      }
  return found;
}

}  // namespace

std::vector<WallCorner> wall_corners(const LiquidScene& scene, const CutCells& cells,
                                     const std::function<double(Index)>& value) {
  std::vector<WallCorner> found;
  const convex::CutGrid& grid = cells.grid;
  const Domain& domain = scene.domain;
  for (const Corner& at : domain.shape == Domain::Shape::polygon ? corners_of_polygon(domain.vertices)
                                                                 : corners_of_sheets(domain, cells)) {
    const Vertex &here = at.here, &m = at.m, &n = at.n;
    const double sine = at.sine();
    if (!(sine > least_sine)) continue;
    WallCorner corner{{here[0], here[1], 0},
                      0,
                      {wall_beside(scene, here, at.along_m), wall_beside(scene, here, at.along_n)},
                      {}};
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
