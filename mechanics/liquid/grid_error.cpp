#include "mechanics/liquid/grid_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace mechanics::liquid {
namespace {

using convex::CutPoint;
using convex::CutSolution;
using convex::Index;

using NodeValue = std::function<double(Index)>;

std::size_t entry_of(Index k) { return static_cast<std::size_t>(k); }

/// How many steps from a junction or corner second differences count.
constexpr Index steps_around = 3;

/// With fewer cells no order is believed, and what bends beside a given pressure counts as a whole, else as
/// an eighth: what a line between two nodes misses.
constexpr long few_cells = 32;

/// The largest difference of two solutions at the nodes of the coarser grid.
double largest_difference(const CutCells& fine, const CutSolution& p, const CutCells& coarse,
                          const CutSolution& q) {
  double largest = 0;
  const auto& n = coarse.grid.points;
  for (Index c = 0; c < n[2]; ++c)
    for (Index b = 0; b < n[1]; ++b)
      for (Index a = 0; a < n[0]; ++a) {
        const std::size_t here = entry_of(coarse.grid.at(a, b, c)),
                          there = entry_of(fine.grid.at(2 * a, 2 * b, 2 * c));
        if (coarse.grid.kind[here] == CutPoint::bounded && fine.grid.kind[there] == CutPoint::bounded)
          largest = std::max(largest, std::abs(p.q[there] - q.q[here]));
      }
  return largest;
}

/// The orders that theory allows: second where all of a smooth boundary is free or held, and not less than
/// first there, since where the cavity's edge lies to the nodes moves the error.
struct Orders {
  double least = 1, most = 2;
};

/// At a corner of a polygon with the inner angle ω, p has r^(π/ω), or r^(π/2ω) where it is free on one side
/// and held on the other.
Orders possible_orders(const LiquidScene& scene) {
  Orders orders;
  const Domain& domain = scene.domain;
  if (scene.has_free_part() && scene.has_wall()) orders.least = 0.5;
  if (domain.sheets.size() > 1) orders.least = 0.5;  // their angles are not known
  if (domain.shape != Domain::Shape::polygon) return orders;
  const std::size_t n = domain.vertices.size();
  const auto is_free_near = [&](const std::array<double, 2>& from, const std::array<double, 2>& to) {
    constexpr double part = 1e-3;
    const BoundaryPart* there =
        scene.part_at({from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1]), 0});
    return there == nullptr || there->is_free;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const auto &a = domain.vertices[(k + n - 1) % n], &b = domain.vertices[k],
               &c = domain.vertices[(k + 1) % n];
    const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - b[0], vy = c[1] - b[1];
    const double angle = std::numbers::pi - std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
    const bool is_mixed = is_free_near(b, a) != is_free_near(b, c);
    const double order = std::numbers::pi / angle / (is_mixed ? 2 : 1);
    orders.most = std::min(orders.most, order);
    orders.least = std::min(orders.least, order);
  }
  return orders;
}

/// Of p beside a given pressure: the largest difference of the steps to it and to the node on the other side.
double largest_bend_at_pressures(const CutCells& cells, const NodeValue& value) {
  constexpr double least_part = 0.1;  // of a step: closer, the difference is rounding
  const convex::CutGrid& grid = cells.grid;
  double largest = 0;
  for (const GivenPressure& given : cells.pressures) {
    const Point node = cells.at(given.from);
    if (grid.kind[entry_of(given.from)] != CutPoint::bounded) continue;
    for (std::size_t axis = 0; axis < grid.dimension; ++axis) {
      const double part = (given.at[axis] - node[axis]) / cells.step[axis];
      if (std::abs(part) < least_part) continue;
      const Index other = given.from + (part > 0 ? -1 : 1) * grid.stride(axis);
      if (!grid.is_unknown(other)) continue;
      const double here = value(given.from),
                   bend = std::abs((given.pressure - here) / std::abs(part) - (here - value(other)));
      if (bend > largest) largest = bend;  // not where a value is none
    }
  }
  return largest;
}

/// |h| s²/8 over the steps s from the nodes of a cavity to those beside it.
double largest_miss_at_edge(const CutCells& cells, const NodeValue& value) {
  const convex::CutGrid& grid = cells.grid;
  double largest = 0;
  for (Index k = 0; k < grid.size(); ++k) {
    if (grid.kind[entry_of(k)] != CutPoint::bounded || !(cells.h[entry_of(k)] < 0) || value(k) != 0) continue;
    for (std::size_t axis = 0; axis < grid.dimension; ++axis)
      for (const Index beside : {k - grid.stride(axis), k + grid.stride(axis)}) {
        if (grid.kind[entry_of(beside)] != CutPoint::bounded || !(value(beside) > 0)) continue;
        const double h = std::max(std::abs(cells.h[entry_of(k)]), std::abs(cells.h[entry_of(beside)]));
        largest = std::max(largest, h * cells.step[axis] * cells.step[axis] / 8);
      }
  }
  return largest;
}

/// Nodes of the boundary, and which of them lie at junctions or corners.
class SingularNodes {
 public:
  SingularNodes(const LiquidScene& scene, const CutCells& cells) : cells_(cells) {
    const std::size_t n = entry_of(cells.grid.size());
    std::vector<bool> near_wall(n);
    for (const WallPiece& wall : cells.walls)
      for_around(wall.point, [&](Index k) { near_wall[entry_of(k)] = true; });
    for (const GivenPressure& given : cells.pressures)
      if (near_wall[entry_of(given.from)]) found_.push_back(given.from);
    for (const auto& vertex : scene.domain.vertices) found_.push_back(nearest({vertex[0], vertex[1], 0}));
    add_edges(scene.domain);
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  }

  /// The largest second difference around them.
  double largest_bend(const NodeValue& value) const {
    const convex::CutGrid& grid = cells_.grid;
    double largest = 0;
    for (const Index centre : found_)
      for_around(centre, [&](Index k) {
        for (std::size_t axis = 0; axis < grid.dimension; ++axis) {
          const Index s = grid.stride(axis);
          if (k - s < 0 || k + s >= grid.size()) continue;
          const double bend = std::abs(value(k - s) - 2 * value(k) + value(k + s));
          if (bend > largest) largest = bend;  // not where a value is none
        }
      });
    return largest;
  }

 private:
  template <class Work>
  void for_around(Index centre, Work work) const {
    const convex::CutGrid& grid = cells_.grid;
    const std::array<Index, 3> middle = cells_.place(centre);
    std::array<Index, 3> low{}, high{};
    for (std::size_t i = 0; i < grid.dimension; ++i) {
      low[i] = std::max<Index>(0, middle[i] - steps_around);
      high[i] = std::min<Index>(grid.points[i] - 1, middle[i] + steps_around);
    }
    for (Index c = low[2]; c <= high[2]; ++c)
      for (Index b = low[1]; b <= high[1]; ++b)
        for (Index a = low[0]; a <= high[0]; ++a) work(grid.at(a, b, c));
  }

  Index nearest(const Point& x) const {
    std::array<Index, 3> at{};
    for (std::size_t i = 0; i < cells_.grid.dimension; ++i)
      at[i] = std::clamp<Index>(std::lround((x[i] - cells_.low[i]) / cells_.step[i]), 0,
                                cells_.grid.points[i] - 1);
    return cells_.grid.at(at[0], at[1], at[2]);
  }

  /// Boundary nodes near which two inequalities are equalities.
  void add_edges(const Domain& domain) {
    if (domain.sheets.size() < 2) return;
    const auto offer = [&](Index k) {
      int passed = 0;
      for (const auto& level : domain.sheets) {
        bool below = false, above = false;
        for (unsigned code = 0; code < 1U << cells_.grid.dimension; ++code) {
          Point corner = cells_.at(k);
          for (std::size_t i = 0; i < cells_.grid.dimension; ++i)
            corner[i] += ((code >> i & 1U) != 0 ? 2 : -2) * cells_.step[i];
          (level(corner) < 0 ? below : above) = true;
        }
        passed += below && above ? 1 : 0;
      }
      if (passed >= 2) found_.push_back(k);
    };
    for (const GivenPressure& given : cells_.pressures) offer(given.from);
    for (const WallPiece& wall : cells_.walls) offer(wall.point);
  }

  const CutCells& cells_;
  std::vector<Index> found_;
};

}  // namespace

double error_by_differences(const LiquidScene& scene, const std::vector<double>& differences, long cells) {
  constexpr double safety = 2;
  constexpr std::size_t most_differences = 4;
  if (differences.empty()) return std::numeric_limits<double>::infinity();
  const Orders possible = possible_orders(scene);
  double order = possible.least, left = differences[0];
  // How many times a grid lies to the boundary as the next coarser one does.
  const int halved = cells % 8 == 0 ? 3 : cells % 4 == 0 ? 2 : 0;
  const auto seen = [&](std::size_t l) { return std::log2(differences[l + 1] / differences[l]); };
  if (halved >= 2 && cells >= few_cells && differences.size() > 1 && left > 0) {
    double shown = seen(0);
    if (scene.has_free_part() && scene.has_wall() && shown > 1)
      shown = halved >= 3 && differences.size() > 2 ? std::clamp(seen(1), 1.0, shown) : 1;
    order = std::clamp(shown, possible.least, possible.most);
  }
  for (std::size_t l = 1; l < std::min(differences.size(), most_differences); ++l)
    left = std::max(left, differences[l] * std::exp2(-order * static_cast<double>(l)));
  return safety * left / (std::exp2(order) - 1);
}

Bends largest_bends(const LiquidScene& scene, const CutCells& cells, long across, const NodeValue& value) {
  return {SingularNodes(scene, cells).largest_bend(value),
          largest_bend_at_pressures(cells, value) / (across < few_cells ? 1 : 8),
          largest_miss_at_edge(cells, value)};
}

double error_by(double differences, const Bends& bends) {
  return std::max(differences + bends.singular + bends.edge, bends.beside);
}

double estimated_grid_error(const LiquidScene& scene, const GridLevels& levels,
                            const std::vector<CutSolution>& found, double largest) {
  constexpr double digits = 1e-9;
  std::vector<double> differences;
  for (std::size_t l = 0; l + 1 < levels.count(); ++l)
    differences.push_back(largest_difference(levels.level(l), found[l], levels.level(l + 1), found[l + 1]));
  const CutCells& finest = levels.finest();
  const auto value = [&](Index k) {
    return finest.grid.is_unknown(k) ? found[0].q[entry_of(k)] : finest.given[entry_of(k)];
  };
  return error_by(error_by_differences(scene, differences, levels.cells()),
                  largest_bends(scene, finest, levels.cells(), value)) +
         finest.hidden + digits * largest;
}

}  // namespace mechanics::liquid
