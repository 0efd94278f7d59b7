#include "mechanics/liquid/cavity_edge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/liquid/simplex_cut.hpp"

namespace mechanics::liquid {
namespace {

using convex::CutPoint;
using convex::Index;

std::size_t place_of(Index k) { return static_cast<std::size_t>(k); }

}  // namespace

CavityEdge::CavityEdge(const CutCells& cells, const convex::CutSolution& found) : cells_(cells) {
  const auto n = place_of(cells.grid.size());
  cavity_.assign(n, false);
  level_.assign(n, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < n; ++k)
    if (found.held[k] != 0 && cells.h[k] < 0) {
      cavity_[k] = true;
      is_empty_ = false;
    }
  if (!is_empty_) find_levels(found);
}

bool CavityEdge::is_liquid(const convex::CutSolution& found, Index k) const {
  return k >= 0 && k < cells_.grid.size() && cells_.grid.kind[place_of(k)] == CutPoint::bounded &&
         found.held[place_of(k)] == 0;
}

/// From a point of the cavity towards a neighbour in the liquid: the steps to the edge, and how much the
/// distance from the edge grows in a step. On the grid p is a parabola that misses 0 by up to h²/8 at its
/// vertex, which is on the edge to second order: the vertex is taken, where differences of p are 0.
std::pair<double, double> CavityEdge::edge_beside(const convex::CutSolution& found, Index k, Index by,
                                                  double curvature, double step) const {
  int count = 0;
  std::array<double, 5> p{};
  while (count < 4 && is_liquid(found, k + (count + 1) * by)) {
    ++count;
    p[static_cast<std::size_t>(count)] = found.q[place_of(k + count * by)];
  }
  if (count < 3) {  // p_1 alone: ½ |h| s²
    const double first = std::sqrt(2 * p[1] / curvature);
    return {1 - std::min(first / step, 1.0), step};
  }
  const double a = p[2] - p[1], b = p[3] - p[2], c = count == 4 ? p[4] - p[3] : 2 * b - a;
  const double slope = 0.5 * (c - a), bend = a - 2 * b + c, root = slope * slope - 2 * bend * b;
  if (!(slope > 0) || !(root >= 0)) return {0, 0};
  const double steps = std::clamp(2.5 - 2 * b / (slope + std::sqrt(root)), -1.0, 2.0);
  return {steps, std::min(step, std::sqrt(slope / curvature))};
}

/// Whether the point or one of those around it is such.
template <class Such>
bool CavityEdge::is_near(Index k, Such such) const {
  const convex::CutGrid& grid = cells_.grid;
  for (Index code = 0; code < 27; ++code) {
    Index there = k, rest = code;
    bool is_used = true;
    for (std::size_t axis = 0; axis < 3; ++axis, rest /= 3) {
      if (axis < grid.dimension)
        there += (rest % 3 - 1) * grid.stride(axis);
      else
        is_used = is_used && rest % 3 == 1;
    }
    if (is_used && such(there)) return true;
  }
  return false;
}

void CavityEdge::find_levels(const convex::CutSolution& found) {
  const convex::CutGrid& grid = cells_.grid;
  double shortest = cells_.step[0];
  for (std::size_t i = 1; i < grid.dimension; ++i) shortest = std::min(shortest, cells_.step[i]);
  const auto n = place_of(grid.size());
  for (std::size_t k = 0; k < n; ++k) {
    if (grid.kind[k] == CutPoint::bounded)
      level_[k] = cavity_[k] ? -1.5 * shortest : 2 * shortest;
    else if (!std::isnan(cells_.given[k]))
      level_[k] = 2 * shortest;
  }
  // Where p = 0 is given the cavity, if it is near, goes up to the boundary.
  for (Index k = 0; k < grid.size(); ++k)
    if (cells_.given[place_of(k)] == 0 && is_near(k, [&](Index there) { return cavity_[place_of(there)]; }))
      level_[place_of(k)] = -0.5 * shortest;
  std::vector<double> sum(n, 0), weight(n, 0);
  for (Index k = 0; k < grid.size(); ++k) {
    if (!cavity_[place_of(k)]) continue;
    const double curvature = -cells_.h[place_of(k)];
    for (std::size_t axis = 0; axis < grid.dimension; ++axis)
      for (const Index by : {-grid.stride(axis), grid.stride(axis)}) {
        if (!is_liquid(found, k + by)) continue;
        const auto [steps, slope] = edge_beside(found, k, by, curvature, cells_.step[axis]);
        if (!(slope > 0)) continue;
        const double first = (1 - steps) * slope;
        const double share = slope * slope;
        const auto offer = [&](Index there, double value) {
          sum[place_of(there)] += share * value;
          weight[place_of(there)] += share;
        };
        offer(k, first - slope);
        offer(k + by, first);
        if (is_liquid(found, k + 2 * by)) offer(k + 2 * by, first + slope);
      }
  }
  std::vector<double> known(n, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < n; ++k)
    if (weight[k] > 0) known[k] = sum[k] / weight[k];
  for (int ring = 0; ring < 2; ++ring) continue_straight(known);
  double longest = shortest;
  for (std::size_t i = 0; i < grid.dimension; ++i) longest = std::max(longest, cells_.step[i]);
  for (std::size_t k = 0; k < n; ++k) {
    if (!std::isnan(known[k])) level_[k] = known[k];
    // Beside walls that part p grows by more than ½ |h| s²: what fits no parabola from an edge is liquid.
    if (is_liquid(found, static_cast<Index>(k)) &&
        found.q[k] > std::max(0.0, -cells_.h[k]) * longest * longest)
      level_[k] = std::max(level_[k], 0.5 * shortest);
  }
}

/// Points beside two in a row whose level is known continue it.
void CavityEdge::continue_straight(std::vector<double>& known) const {
  const convex::CutGrid& grid = cells_.grid;
  const std::vector<double> before = known;
  for (Index k = 0; k < grid.size(); ++k) {
    if (!std::isnan(before[place_of(k)]) || grid.kind[place_of(k)] != CutPoint::bounded) continue;
    double sum = 0, weight = 0;
    for (std::size_t axis = 0; axis < grid.dimension; ++axis)
      for (const Index by : {-grid.stride(axis), grid.stride(axis)}) {
        const Index beyond = k + 2 * by;
        if (beyond < 0 || beyond >= grid.size()) continue;
        const double near = before[place_of(k + by)], far = before[place_of(beyond)];
        if (std::isnan(near) || std::isnan(far)) continue;
        const double share = (near - far) * (near - far);
        sum += share * (2 * near - far);
        weight += share;
      }
    if (weight > 0) known[place_of(k)] = sum / weight;
  }
}

double CavityEdge::level(const Point& x) const {
  if (is_empty_) return 1;
  const convex::CutGrid& grid = cells_.grid;
  std::array<Index, 3> low{0, 0, 0};
  std::array<double, 3> part{};
  for (std::size_t i = 0; i < grid.dimension; ++i) {
    const double here = (x[i] - cells_.low[i]) / cells_.step[i];
    low[i] = std::clamp<Index>(static_cast<Index>(std::floor(here)), 0, grid.points[i] - 2);
    part[i] = std::clamp(here - static_cast<double>(low[i]), 0.0, 1.0);
  }
  double sum = 0, weights = 0;
  for (unsigned code = 0; code < 1U << grid.dimension; ++code) {
    Index k = grid.at(low[0], low[1], low[2]);
    double weight = 1;
    for (std::size_t i = 0; i < grid.dimension; ++i) {
      const bool is_high = (code >> i & 1U) != 0;
      weight *= is_high ? part[i] : 1 - part[i];
      if (is_high) k += grid.stride(i);
    }
    const double value = level_[place_of(k)];
    if (std::isnan(value)) continue;
    sum += weight * value;
    weights += weight;
  }
  return weights > 0 ? sum / weights : 1;
}

/// -1 or 1 where the level around a point, up to the next nodes, has that sign; else 0.
int CavityEdge::sign_around(Index k) const {
  bool below = false, above = false;
  is_near(k, [&](Index there) {
    const double level = level_[place_of(there)];
    below = below || !(level >= 0);
    above = above || !(level < 0);
    return below && above;
  });
  return below && above ? 0 : below ? -1 : 1;
}

double CavityEdge::measure(const Domain& domain) const {
  if (is_empty_) return 0;
  const convex::CutGrid& grid = cells_.grid;
  const bool may_reach = std::any_of(cells_.pressures.begin(), cells_.pressures.end(),
                                     [](const GivenPressure& given) { return given.pressure == 0; });
  const bool is_box = domain.shape == Domain::Shape::box;  // its cells are boxes too
  double sum = 0;
  for (Index c = 0; c < grid.points[2]; ++c)
    for (Index b = 0; b < grid.points[1]; ++b)
      for (Index a = 0; a < grid.points[0]; ++a) {
        const Index k = grid.at(a, b, c);
        const bool is_given = may_reach && is_near(k, [&](Index there) {
                                return grid.kind[place_of(there)] == CutPoint::fixed;
                              });
        if (grid.kind[place_of(k)] != CutPoint::bounded && !is_given) continue;
        const int sign = is_given ? 0 : sign_around(k);
        if (sign > 0) continue;
        if (sign < 0 && !is_box) {
          sum += cells_.volume[place_of(k)];
          continue;
        }
        CellLevels cell;
        cell.dimension = grid.dimension;
        bool below = false, above = false;
        Point low = cells_.at(k), high = low;
        double whole = 1;
        for (std::size_t i = 0; i < grid.dimension; ++i) {
          low[i] -= 0.5 * cells_.step[i];
          high[i] += 0.5 * cells_.step[i];
          if (is_box) {
            low[i] = std::max(low[i], domain.low[i]);
            high[i] = std::min(high[i], domain.high[i]);
          }
          whole *= high[i] - low[i];
        }
        for (unsigned code = 0; code < 1U << grid.dimension; ++code) {
          Point corner = low;
          for (std::size_t i = 0; i < grid.dimension; ++i)
            if ((code >> i & 1U) != 0) corner[i] = high[i];
          cell.at[code] = is_given && !is_box ? std::max(level(corner), domain.level(corner)) : level(corner);
          (cell.at[code] < 0 ? below : above) = true;
        }
        if (!below) continue;
        sum += (is_given || is_box ? whole : cells_.volume[place_of(k)]) * (above ? cell.fraction() : 1);
      }
  return sum;
}

std::pair<Point, Point> CavityEdge::extent() const {
  const convex::CutGrid& grid = cells_.grid;
  Point low{}, high{};
  for (std::size_t i = 0; i < grid.dimension; ++i) {
    low[i] = std::numeric_limits<double>::infinity();
    high[i] = -low[i];
  }
  const auto offer = [&](const Point& x) {
    for (std::size_t i = 0; i < grid.dimension; ++i) {
      low[i] = std::min(low[i], x[i]);
      high[i] = std::max(high[i], x[i]);
    }
  };
  for (Index k = 0; k < grid.size(); ++k) {
    const double here = level_[place_of(k)];
    if (!(here < 0) || !grid.is_unknown(k)) continue;
    const Point x = cells_.at(k);
    for (std::size_t i = 0; i < grid.dimension; ++i)
      for (const int by : {-1, 1}) {
        Point end = x;
        const double there = level_[place_of(k + by * grid.stride(i))];
        if (there > 0) end[i] += by * cells_.step[i] * here / (here - there);
        offer(end);
      }
  }
  // Up to the boundary, where it gives p = 0 or is a wall.
  for (const GivenPressure& given : cells_.pressures)
    if (given.pressure == 0 && level_[place_of(given.from)] < 0) offer(given.at);
  for (const WallPiece& wall : cells_.walls)
    if (level_[place_of(wall.point)] < 0 && level(wall.at) < 0) offer(wall.at);
  return {low, high};
}

}  // namespace mechanics::liquid
