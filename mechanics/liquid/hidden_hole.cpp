#include "mechanics/liquid/hidden_hole.hpp"

#include "mechanics/liquid/hidden_values.hpp"
#include "mechanics/liquid/polygon.hpp"

namespace mechanics::liquid {
namespace {

using convex::Index;

/// Halvings of a cell along each axis, and boxes that are looked at within cells.
constexpr int most_halvings = 10;
constexpr long most_boxes = 200000;

Point node(const CutCells& cells, const Places& place) {
  Point x{};
  for (std::size_t i = 0; i < cells.grid.dimension; ++i)
    x[i] = cells.low[i] + static_cast<double>(place[i]) * cells.step[i];
  return x;
}

/// Whether all nodes of a cell and of those around it are inside: no boundary that the grid sees is near.
bool is_far_inside(const Domain& domain, const CutCells& cells, const Places& cell) {
  Places low{}, high{};
  for (std::size_t i = 0; i < domain.dimension; ++i) {
    low[i] = cell[i] - 1;
    high[i] = cell[i] + 2;
    if (low[i] < 0 || high[i] >= cells.grid.points[i]) return false;
  }
  for (Index c = low[2]; c <= high[2]; ++c)
    for (Index b = low[1]; b <= high[1]; ++b)
      for (Index a = low[0]; a <= high[0]; ++a)
        if (!(domain.level(node(cells, {a, b, c})) < 0)) return false;
  return true;
}

/// A node of a domain that is one node thick at most of those looked at.
std::optional<Point> thin_place(const Domain& domain, const CutCells& cells) {
  constexpr Index most_looked_at = 200000;
  const convex::CutGrid& grid = cells.grid;
  const auto is_outside = [&](Index k) { return !(domain.level(cells.at(k)) < 0); };
  const Index every = 1 + grid.size() / most_looked_at;
  Index inside = 0, thin = 0;
  std::optional<Point> found;
  for (Index k = 0; k < grid.size(); k += every) {
    if (is_outside(k)) continue;
    ++inside;
    for (std::size_t axis = 0; axis < domain.dimension; ++axis) {
      const Index step = grid.stride(axis);
      if ((k >= step && !is_outside(k - step)) || (k + step < grid.size() && !is_outside(k + step))) continue;
      ++thin;
      found = cells.at(k);
      break;
    }
  }
  return 2 * thin > inside ? found : std::nullopt;
}

}  // namespace

std::optional<Point> hidden_hole(const Domain& domain, const CutCells& cells) {
  if (domain.shape == Domain::Shape::polygon) {
    // In cells. A strip along an axis that is as wide as one has nodes.
    std::vector<Vertex> vertices = domain.vertices;
    for (Vertex& v : vertices) v = {v[0] / cells.step[0], v[1] / cells.step[1]};
    constexpr double nearly_one = 1 - 1e-6;
    const auto found = narrow_place(vertices, nearly_one);
    if (!found) return std::nullopt;
    return Point{(*found)[0] * cells.step[0], (*found)[1] * cells.step[1], 0};
  }
  if (!domain.condition) return std::nullopt;
  if (const auto thin = thin_place(domain, cells)) return thin;
  const auto level = [&](const Region& at) {
    const expression::Range values = domain.condition->range(at);
    return values.is_empty() ? convex::infinity : values.high;
  };
  std::optional<Point> found;
  const auto is_hole = [&](const Region& at, double, int) {
    const Point middle = middle_of(at);
    if (domain.level(middle) > domain.reach()) found = middle;
    return found.has_value();
  };
  long boxes = most_boxes;
  Places last{};
  for (std::size_t i = 0; i < domain.dimension; ++i) last[i] = std::max<Index>(2, cells.grid.points[i]) - 2;
  halve_places({}, last, [&](const Places& first, const Places& end) {
    Places next = end;
    for (std::size_t i = 0; i < domain.dimension; ++i) ++next[i];
    const Point low = node(cells, first), high = node(cells, next);
    const Region at{{{low[0], high[0]}, {low[1], high[1]}, {low[2], high[2]}}};
    if (found || level(at) < 0) return true;
    if (first == end && is_far_inside(domain, cells, first))
      search(at, {domain.dimension, most_halvings, &boxes}, level, is_hole);
    return false;
  });
  return found;
}

}  // namespace mechanics::liquid
