#include "mechanics/liquid/junction_flux.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace mechanics::liquid {
namespace {

using convex::Index;

/// How many nodes around one tell of the gradient there.
constexpr Index steps_around_end = 2;
/// A part of a face that rounding may leave open.
constexpr double closed_part = 1e-9;
/// Pressures given at points that lie within this part of a step across a direction do not tell a slope.
constexpr double least_spread = 0.1;

std::size_t entry_at(Index k) { return static_cast<std::size_t>(k); }

double product(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Two unit vectors at right angles to n and each other; in the plane the second is 0.
std::array<Point, 2> tangents(const Point& n, std::size_t dimension) {
  if (dimension == 2) return {Point{-n[1], n[0], 0}, Point{}};
  Point other{};
  other[static_cast<std::size_t>(
      std::min_element(n.begin(), n.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) -
      n.begin())] = 1;
  const auto cross = [](const Point& a, const Point& b) {
    return Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  Point first = cross(n, other);
  const double length = std::sqrt(product(first, first));
  for (double& one : first) one /= length;
  return {first, cross(n, first)};
}

/// Which of some things lie at a node, sorted by nodes.
class ByNode {
 public:
  template <class Things, class NodeOf>
  ByNode(const Things& things, NodeOf node_of) {
    for (std::size_t i = 0; i < things.size(); ++i) sorted_.emplace_back(node_of(things[i]), i);
    std::sort(sorted_.begin(), sorted_.end());
  }
  template <class Work>
  void at(Index node, Work work) const {
    auto one = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{node, std::size_t{0}});
    for (; one != sorted_.end() && one->first == node; ++one) work(one->second);
  }

 private:
  std::vector<std::pair<Index, std::size_t>> sorted_;
};

class Junctions {
 public:
  Junctions(const LiquidScene& scene, CutCells& cells, const std::vector<Point>& normals)
      : scene_(scene),
        cells_(cells),
        normals_(normals),
        d_(cells.grid.dimension),
        pressures_(cells.pressures, [](const GivenPressure& given) { return given.from; }),
        walls_(cells.walls, [](const WallPiece& piece) { return piece.point; }) {
    if (scene.bound != Bound::none)
      other_ = scene.bounded(scene.bound == Bound::lower ? Bound::upper : Bound::lower);
  }

  /// What flows through a surface of vector area a at a node; 0 where no wall or no free part is near.
  double flux(Index node, const Point& a) const {
    const Point x = cells_.at(node);
    const WallPiece* wall = nullptr;
    Point n{};
    double nearest = 0;
    std::vector<const GivenPressure*> given;
    around(node, [&](Index k) {
      pressures_.at(k, [&](std::size_t i) { given.push_back(&cells_.pressures[i]); });
      walls_.at(k, [&](std::size_t i) {
        const Point& at = cells_.walls[i].at;
        const double away = std::hypot(at[0] - x[0], at[1] - x[1], at[2] - x[2]);
        if (!(cells_.walls[i].area > 0) || (wall != nullptr && !(away < nearest))) return;
        wall = &cells_.walls[i];
        n = normals_[i];
        nearest = away;
      });
    });
    if (wall == nullptr || given.empty()) return 0;
    return sum(a, *wall, n, given);
  }

 private:
  template <class Work>
  void around(Index node, Work work) const {
    const auto place = cells_.place(node);
    std::array<Index, 3> low{}, high{};
    for (std::size_t i = 0; i < d_; ++i) {
      low[i] = std::max<Index>(0, place[i] - steps_around_end);
      high[i] = std::min<Index>(cells_.grid.points[i] - 1, place[i] + steps_around_end);
    }
    for (Index c = low[2]; c <= high[2]; ++c)
      for (Index b = low[1]; b <= high[1]; ++b)
        for (Index i = low[0]; i <= high[0]; ++i) work(cells_.grid.at(i, b, c));
  }

  /// a·∇p, written as a sum over the pressures given and the wall's slope, whose bounds bound it.
  double sum(const Point& a, const WallPiece& wall, const Point& n,
             const std::vector<const GivenPressure*>& given) const {
    const auto tangent = tangents(n, d_);
    Point middle{};
    for (const GivenPressure* one : given)
      for (std::size_t i = 0; i < d_; ++i) middle[i] += one->at[i] / static_cast<double>(given.size());
    const auto off = [&](const GivenPressure* one) {
      Point by{};
      for (std::size_t i = 0; i < d_; ++i) by[i] = one->at[i] - middle[i];
      return by;
    };
    double xx = 0, xy = 0, yy = 0;
    for (const GivenPressure* one : given) {
      const Point by = off(one);
      const double s = product(by, tangent[0]), t = product(by, tangent[1]);
      xx += s * s;
      xy += s * t;
      yy += t * t;
    }
    const double step = *std::min_element(cells_.step.begin(), cells_.step.begin() + static_cast<long>(d_));
    const double needed = static_cast<double>(given.size()) * std::pow(least_spread * step, 2);
    if (d_ == 2) yy = std::max(xx, needed);
    const double least = 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy);
    const double more = std::max(0.0, needed - least);
    xx += more;
    yy += more;
    // The weights of the two slopes in a·∇p, times the inverse of the normal equations' matrix.
    const double u = product(a, tangent[0]), v = product(a, tangent[1]), det = xx * yy - xy * xy;
    const double along_x = (u * yy - v * xy) / det, along_y = (v * xx - u * xy) / det;
    double of_slope = product(a, n), total = 0;
    for (const GivenPressure* one : given) {
      const Point by = off(one);
      const double share = along_x * product(by, tangent[0]) + along_y * product(by, tangent[1]);
      of_slope -= share * product(by, n);
      total += share * pressure(*one, share);
    }
    return total + of_slope * slope(wall, n, of_slope);
  }

  /// Of a scene that is a bound of others a share below 0 takes the other bound.
  double pressure(const GivenPressure& given, double share) const {
    if (share >= 0 || !other_) return given.pressure;
    const BoundaryPart* part = other_->part_at(given.at);
    return part != nullptr && part->is_free ? other_->free_pressure(*part, given.at) : given.pressure;
  }
  double slope(const WallPiece& wall, const Point& n, double share) const {
    if (share >= 0 || !other_) return wall.load / wall.area;
    return other_->wall_flux(other_->parts[wall.part], wall.at, n);
  }

  const LiquidScene& scene_;
  std::optional<LiquidScene> other_;
  CutCells& cells_;
  const std::vector<Point>& normals_;
  std::size_t d_;
  ByNode pressures_, walls_;
};

}  // namespace

void close_junctions(const LiquidScene& scene, CutCells& cells, std::vector<Point> open,
                     const std::vector<Point>& normals) {
  const convex::CutGrid& grid = cells.grid;
  if (grid.dimension < 2) return;
  for (std::size_t a = 0; a < cells.walls.size(); ++a)
    for (std::size_t i = 0; i < 3; ++i)
      open[entry_at(cells.walls[a].point)][i] += cells.walls[a].area * normals[a][i];
  for (std::size_t i = 0; i < grid.dimension; ++i)
    for (Index k = 0; k < grid.size(); ++k) {
      const double area = grid.link[i][entry_at(k)] * cells.step[i];
      if (area == 0) continue;
      open[entry_at(k)][i] += area;
      open[entry_at(k + grid.stride(i))][i] -= area;
    }
  const Junctions junctions(scene, cells, normals);
  double face = 0;
  for (std::size_t i = 0; i < grid.dimension; ++i) face = std::max(face, cells.face_area(i));
  for (Index k = 0; k < grid.size(); ++k) {
    const Point& a = open[entry_at(k)];
    if (!grid.is_unknown(k) || std::sqrt(product(a, a)) <= closed_part * face) continue;
    cells.grid.load[entry_at(k)] += junctions.flux(k, {-a[0], -a[1], -a[2]});
  }
}

}  // namespace mechanics::liquid
