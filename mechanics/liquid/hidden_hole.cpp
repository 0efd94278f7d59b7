#include "mechanics/liquid/hidden_hole.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace mechanics::liquid {
namespace {

using convex::Index;
using Places = std::array<Index, 3>;

/// Halvings of a cell along each axis, and boxes that are looked at within cells; intervals that stay wide
/// take no more.
constexpr int most_halvings = 10;
constexpr long most_boxes = 200000;

class HoleSearch {
 public:
  HoleSearch(const Domain& domain, const CutCells& cells) : domain_(domain), cells_(cells) {}

  std::optional<Point> whole() {
    Places end{1, 1, 1};
    for (std::size_t i = 0; i < domain_.dimension; ++i)
      end[i] = std::max<Index>(1, cells_.grid.points[i] - 1);
    return among({}, end);
  }

 private:
  Point node(const Places& place) const {
    Point x{};
    for (std::size_t i = 0; i < domain_.dimension; ++i)
      x[i] = cells_.low[i] + static_cast<double>(place[i]) * cells_.step[i];
    return x;
  }

  bool is_inside(const Point& low, const Point& high) const {
    Region at{};
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = {low[i], high[i]};
    return domain_.condition->range(at).high < 0;
  }

  /// In the cells from `begin` to before `end`.
  std::optional<Point> among(const Places& begin, const Places& end) {
    if (is_inside(node(begin), node(end))) return std::nullopt;
    std::size_t axis = 0;
    for (std::size_t i = 1; i < domain_.dimension; ++i)
      if (end[i] - begin[i] > end[axis] - begin[axis]) axis = i;
    if (end[axis] - begin[axis] <= 1)
      return is_far_inside(begin) ? within(node(begin), node(end), 0) : std::nullopt;
    Places middle_end = end, middle_begin = begin;
    middle_end[axis] = middle_begin[axis] = (begin[axis] + end[axis]) / 2;
    if (const auto found = among(begin, middle_end)) return found;
    return among(middle_begin, end);
  }

  /// Whether all nodes of a cell and of those around it are inside: no boundary that the grid sees is near.
  bool is_far_inside(const Places& cell) const {
    Places low{}, high{};
    for (std::size_t i = 0; i < domain_.dimension; ++i) {
      low[i] = cell[i] - 1;
      high[i] = cell[i] + 2;
      if (low[i] < 0 || high[i] >= cells_.grid.points[i]) return false;
    }
    for (Index c = low[2]; c <= high[2]; ++c)
      for (Index b = low[1]; b <= high[1]; ++b)
        for (Index a = low[0]; a <= high[0]; ++a)
          if (!(domain_.level(node({a, b, c})) < 0)) return false;
    return true;
  }

  std::optional<Point> within(const Point& low, const Point& high, int halvings) {
    if (++boxes_ > most_boxes || is_inside(low, high)) return std::nullopt;
    Point middle{};
    for (std::size_t i = 0; i < domain_.dimension; ++i) middle[i] = 0.5 * (low[i] + high[i]);
    if (domain_.level(middle) > domain_.reach()) return middle;
    if (halvings == most_halvings) return std::nullopt;
    for (unsigned code = 0; code < 1U << domain_.dimension; ++code) {
      Point from = low, to = high;
      for (std::size_t i = 0; i < domain_.dimension; ++i) ((code >> i & 1U) != 0 ? from : to)[i] = middle[i];
      if (const auto found = within(from, to, halvings + 1)) return found;
    }
    return std::nullopt;
  }

  const Domain& domain_;
  const CutCells& cells_;
  long boxes_ = 0;
};

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
  return HoleSearch(domain, cells).whole();
}

}  // namespace mechanics::liquid
