#include "mechanics/liquid/grid_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "convex/invalid_input.hpp"
#include "mechanics/liquid/cavity_edge.hpp"
#include "mechanics/liquid/grid_error.hpp"
#include "mechanics/liquid/grid_pressure.hpp"
#include "mechanics/liquid/hidden_flux.hpp"
#include "mechanics/liquid/hidden_hole.hpp"
#include "mechanics/liquid/hidden_part.hpp"
#include "mechanics/liquid/hidden_pressure.hpp"
#include "mechanics/liquid/largest_pressure.hpp"
#include "mechanics/liquid/polygon.hpp"
#include "mechanics/liquid/simplex_cut.hpp"
#include "mechanics/liquid/wall_corners.hpp"

namespace mechanics::liquid {
namespace {

using convex::CutPoint;
using convex::CutSolution;
using convex::Index;

std::size_t index_of(Index k) { return static_cast<std::size_t>(k); }

/// The first grid tried, and the finest, by dimension.
constexpr std::array<long, 3> first_cells{256, 256, 32}, most_cells{65536, 1024, 128};

/// Calls work(k, point) for every node, framed index k.
template <class Work>
void for_nodes(const CutCells& cells, Work work) {
  const auto& n = cells.grid.points;
  for (Index c = 0; c < n[2]; ++c)
    for (Index b = 0; b < n[1]; ++b)
      for (Index a = 0; a < n[0]; ++a) work(cells.grid.at(a, b, c), std::array<Index, 3>{a, b, c});
}

double content(const LiquidScene& scene, const CutCells& cells) {
  const Domain& domain = scene.domain;
  using std::numbers::pi;
  if (domain.shape == Domain::Shape::polygon) return polygon_area(domain.vertices);
  if (domain.shape == Domain::Shape::ball)
    return domain.dimension == 2 ? pi * domain.radius * domain.radius
                                 : 4 * pi / 3 * std::pow(domain.radius, 3);
  double sum = 0;
  if (domain.shape == Domain::Shape::box) {
    sum = 1;
    for (std::size_t i = 0; i < domain.dimension; ++i) sum *= domain.high[i] - domain.low[i];
    return sum;
  }
  double cell_volume = 1;
  for (std::size_t i = 0; i < domain.dimension; ++i) cell_volume *= cells.step[i];
  for_nodes(cells, [&](Index k, const std::array<Index, 3>&) {
    sum += cell_volume * part_in_domain(scene.domain, cells.at(k), cells.step);
  });
  return sum;
}

/// How far p goes on below 0 to the corners of walls. A pressure with that added satisfies all that p* is the
/// least of, so that p* is between them; in cells at a corner the grid has no node to part at.
double lacking_at(const std::vector<WallCorner>& corners) {
  double lacking = 0;
  for (const WallCorner& corner : corners) lacking = std::max(lacking, -corner.p);
  return lacking;
}

/// The walls that push less than they would have to be followed: p = 0 on them, strictly.
std::vector<std::string> parted_walls(const LiquidScene& scene, const CutCells& cells,
                                      const CutSolution& found, const std::vector<WallCorner>& corners,
                                      double largest) {
  double scale = 0;
  for (const WallPiece& wall : cells.walls) scale = std::max(scale, std::abs(wall.load));
  std::vector<bool> parts(scene.parts.size());
  constexpr double digits = 1e-6;
  for (const WallPiece& wall : cells.walls) {
    if (!(wall.load < -digits * scale) || parts[wall.part] ||
        !scene.wall_leaves(scene.parts[wall.part], wall.at))
      continue;
    if (wall.pendant >= 0) {
      const convex::Pendant& pendant = cells.grid.pendants[index_of(wall.pendant)];
      const double y = found.q[index_of(pendant.point)] + pendant.shift;
      if (-y * pendant.conductance > digits * scale) parts[wall.part] = true;
      continue;
    }
    const std::size_t k = index_of(wall.point);
    if (found.held[k] == 0 || cells.grid.kind[k] != CutPoint::bounded) continue;
    const double by_cavity = std::max(0.0, -cells.h[k] * cells.volume[k]);
    if (found.push[k] - by_cavity > digits * scale) parts[wall.part] = true;
  }
  for (const WallCorner& corner : corners)
    for (std::size_t i = 0; i < 2; ++i)
      if (corner.p < -digits * largest && corner.flux[i] < 0)
        parts[static_cast<std::size_t>(corner.walls[i] - scene.parts.data())] = true;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (parts[k]) names.push_back(scene.parts[k].name);
  return names;
}

/// Parts, but for those that take what is left, of no boundary point of the grid.
std::vector<std::string> empty_parts(const LiquidScene& scene, const CutCells& cells) {
  std::vector<bool> seen(scene.parts.size());
  for (const WallPiece& wall : cells.walls) seen[wall.part] = true;
  for (const GivenPressure& given : cells.pressures)
    if (const BoundaryPart* part = scene.part_at(given.at))
      seen[static_cast<std::size_t>(part - scene.parts.data())] = true;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < seen.size(); ++k)
    if (!seen[k] && !scene.parts[k].where.is_always()) names.push_back(scene.parts[k].name);
  return names;
}

void require_no_divergence_in_liquid(const LiquidScene& scene, const CutCells& cells,
                                     const CutSolution& found) {
  if (std::all_of(scene.stretching.begin(), scene.stretching.end(),
                  [](const Field& stretch) { return stretch.is_constant() && stretch.raw({}) == 0; }))
    return;
  for_nodes(cells, [&](Index k, const std::array<Index, 3>&) {
    if (cells.grid.kind[index_of(k)] == CutPoint::bounded && found.held[index_of(k)] == 0)
      scene.require_no_divergence(cells.at(k));
  });
}

/// Whether the unknowns hang together by links.
bool is_connected(const CutCells& cells) {
  const convex::CutGrid& grid = cells.grid;
  std::vector<bool> seen(index_of(grid.size()));
  const auto is_there = [&](Index k) { return grid.is_unknown(k) || !std::isnan(cells.given[index_of(k)]); };
  Index parts = 0;
  for (Index first = 0; first < grid.size(); ++first) {
    if (!is_there(first) || seen[index_of(first)]) continue;
    if (++parts > 1) return false;
    std::vector<Index> open{first};
    seen[index_of(first)] = true;
    while (!open.empty()) {
      const Index k = open.back();
      open.pop_back();
      for (std::size_t axis = 0; axis < grid.dimension; ++axis)
        for (const Index there : {k - grid.stride(axis), k + grid.stride(axis)})
          if (is_there(there) && !seen[index_of(there)]) {
            seen[index_of(there)] = true;
            open.push_back(there);
          }
    }
  }
  return true;
}

/// Of the nodes and walls.
template <class Offer>
void for_values(const CutCells& cells, const CutSolution& found, Offer offer) {
  for (std::size_t k = 0; k < found.q.size(); ++k)
    if (cells.grid.kind[k] == CutPoint::bounded) offer(found.q[k]);
  for (const convex::Pendant& pendant : cells.grid.pendants)
    offer(found.q[index_of(pendant.point)] + pendant.shift);
}

double least_value(const CutCells& cells, const CutSolution& found) {
  double least = std::numeric_limits<double>::infinity();
  for_values(cells, found, [&](double p) { least = std::min(least, p); });
  return least;
}

/// Without a free part: whether walls and h squeeze the liquid, balance, or lack liquid, as far as the
/// difference of two grids tells.
enum class Closed { squeezed, balanced, lacking };
Closed closed_state(const GridLevels& levels, LiquidSolution& solution) {
  constexpr double digits = 1e-10, safety = 2;
  const auto [sum, absolute] = levels.surplus(0);
  double slack = digits * absolute;
  if (levels.count() > 1) slack += safety * std::abs(sum - levels.surplus(1).first);
  solution.surplus = std::abs(sum) <= slack ? 0 : sum;
  return solution.surplus == 0 ? Closed::balanced : sum > 0 ? Closed::squeezed : Closed::lacking;
}

std::vector<CutSolution> solve_balanced(const LiquidScene& scene, GridLevels& levels) {
  levels.balance();
  std::vector<CutSolution> found = levels.solve(false);
  for (std::size_t l = 0; l < found.size(); ++l) {
    double least = least_value(levels.level(l), found[l]);
    for (const WallCorner& corner :
         wall_corners(scene, levels.level(l), [&](Index k) { return found[l].q[index_of(k)]; }))
      least = std::min(least, corner.p);
    for (double& p : found[l].q) p -= least;
  }
  return found;
}

/// "... has a hole at ... that lies", of what is not there for a grid; or "".
std::string hidden_between_nodes(const LiquidScene& scene, const CutCells& cells) {
  if (const auto hole = hidden_hole(scene.domain, cells))
    return "domain: it has a hole or a gap at " + point_text(scene.coordinates, *hole) +
           ", or is so narrow there, that it lies";
  if (const auto hidden = hidden_part(scene, cells)) {
    if (hidden->part == nullptr) static_cast<void>(scene.boundary_part(hidden->at));  // throws
    return std::string(hidden->part->is_free ? "free." : "walls.") + hidden->part->name +
           ": it has a piece at " + point_text(scene.coordinates, hidden->at) + " that lies";
  }
  return "";
}

/// Grids from the first one on until the pressure is known well enough. Empty when the scene is infeasible.
std::vector<CutSolution> solve_well_enough(const LiquidScene& scene, const LiquidAccuracy& accuracy,
                                           GridLevels& levels, LiquidSolution& solution,
                                           std::vector<WallCorner>& corners) {
  const std::size_t axis = scene.dimension() - 1;
  for (;; levels.refine()) {
    const bool is_closed = !levels.has_pull();
    const Closed closed = is_closed ? closed_state(levels, solution) : Closed::lacking;
    if (closed == Closed::squeezed) {
      solution.status = LiquidSolution::Status::infeasible;
      return {};
    }
    const bool is_last = scene.cells || 2 * levels.cells() > most_cells[axis];
    if (const std::string hidden = hidden_between_nodes(scene, levels.finest()); !hidden.empty()) {
      if (is_last)
        throw convex::InvalidInput(hidden + " between the nodes of a grid of " +
                                   std::to_string(levels.cells()) +
                                   " cells; give more cells, or leave it out");
      continue;
    }
    std::vector<CutSolution> found =
        closed == Closed::balanced ? solve_balanced(scene, levels) : levels.solve(true);
    const CutCells& finest = levels.finest();
    const auto value = [&](Index k) {
      return finest.grid.is_unknown(k) ? found[0].q[index_of(k)] : finest.given[index_of(k)];
    };
    const LargestPressure largest = largest_pressure(scene, finest, value);
    solution.largest = largest.p;
    solution.largest_at = largest.at;
    corners = wall_corners(scene, finest, value);
    solution.error_bound = estimated_grid_error(scene, levels, found, solution.largest) +
                           hidden_pressure(scene, finest, solution.largest) +
                           hidden_flux(scene, finest, solution.largest) + lacking_at(corners);
    solution.cavity_measure = CavityEdge(levels.level(0), found[0]).measure(scene.domain);
    const double size = solution.largest > 0 ? solution.largest : scene.pressure_scale();
    const bool is_close =
        std::isfinite(solution.error_bound) && solution.error_bound <= accuracy.part() * size;
    if (is_last || is_close) {
      if (!found.front().ended || !is_close) solution.status = LiquidSolution::Status::inaccurate;
      return found;
    }
  }
}

}  // namespace

double part_in_domain(const Domain& domain, const Point& node, const Point& step) {
  CellLevels cell;
  cell.dimension = domain.dimension;
  for (unsigned code = 0; code < 1U << domain.dimension; ++code) {
    Point corner = node;
    for (std::size_t i = 0; i < domain.dimension; ++i)
      corner[i] += ((code >> i & 1U) != 0 ? 0.5 : -0.5) * step[i];
    cell.at[code] = domain.level(corner);
  }
  return cell.fraction();
}

LiquidSolution solve_grid_scene(const LiquidScene& scene, const LiquidAccuracy& accuracy) {
  const std::size_t axis = scene.dimension() - 1;
  LiquidSolution solution;
  solution.method = "grid";
  GridLevels levels(scene, scene.cells.value_or(first_cells[axis]));
  if (levels.finest().grid.unknowns() == 0)
    throw convex::InvalidInput("domain: the grid has no point inside; give more cells");
  if (scene.domain.condition && !is_connected(levels.finest()))
    throw convex::InvalidInput(
        "domain: it is not connected, or not by nodes of a grid of " + std::to_string(levels.cells()) +
        " cells; give one part of it, the others files of their own, or give more cells");
  std::vector<WallCorner> corners;
  const std::vector<CutSolution> found = solve_well_enough(scene, accuracy, levels, solution, corners);
  solution.unknowns = levels.finest().grid.unknowns();
  solution.cells = levels.cells();
  if (found.empty()) return solution;
  const CutCells& cells = levels.finest();
  if (accuracy.proved)
    if (const double bound = levels.enclosed_error(found.front()); std::isfinite(bound))
      solution.grid_bound = bound;
  require_no_divergence_in_liquid(scene, cells, found.front());
  solution.volume = content(scene, cells);
  solution.parted_walls = parted_walls(scene, cells, found.front(), corners, solution.largest);
  solution.empty_parts = empty_parts(scene, cells);
  const auto pressure = std::make_shared<const GridPressure>(levels.take_finest(), found.front().q);
  const auto edge = std::make_shared<const CavityEdge>(pressure->cells(), found.front());
  if (!edge->is_empty()) {
    if (solution.cavity_measure > 0) solution.cavity_extent = edge->extent();
  }
  solution.p = [pressure](const Point& x) { return (*pressure)(x); };
  solution.in_cavity = [pressure, edge](const Point& x) { return edge->level(x) < 0; };
  return solution;
}

double least_grid_pressure(const LiquidScene& scene, long cells) {
  const GridLevels levels(scene, cells);
  if (!levels.has_pull()) return levels.surplus(0).first;
  const CutSolution found = std::move(levels.solve(false).front());
  const CutCells& grid = levels.finest();
  double least = std::numeric_limits<double>::infinity(), scale = 0;
  for (const GivenPressure& given : grid.pressures) {
    least = std::min(least, given.pressure);
    scale = std::max(scale, given.pressure);
  }
  for_nodes(grid, [&](Index k, const std::array<Index, 3>&) {
    if (grid.grid.kind[index_of(k)] != CutPoint::bounded) return;
    double p = found.q[index_of(k)];
    scale = std::max(scale, std::abs(p));
    for (std::size_t axis = 0; axis < grid.grid.dimension;
         ++axis) {  // the bottom of the parabola through three
      const Index s = grid.grid.stride(axis);
      if (grid.grid.kind[index_of(k - s)] != CutPoint::bounded ||
          grid.grid.kind[index_of(k + s)] != CutPoint::bounded)
        continue;
      const double low = found.q[index_of(k - s)], here = found.q[index_of(k)],
                   high = found.q[index_of(k + s)];
      const double bend = low - 2 * here + high, tilt = 0.5 * (high - low);
      if (low >= here && high >= here && bend > 0) p -= 0.5 * tilt * tilt / bend;
    }
    least = std::min(least, p);
  });
  for (const convex::Pendant& pendant : grid.grid.pendants)
    least = std::min(least, found.q[index_of(pendant.point)] + pendant.shift);
  for (const WallCorner& corner : wall_corners(scene, grid, [&](Index k) { return found.q[index_of(k)]; }))
    least = std::min(least, corner.p);
  constexpr double digits = 1e-9;  // of the solve
  return std::abs(least) <= digits * scale ? 0 : least;
}

}  // namespace mechanics::liquid
