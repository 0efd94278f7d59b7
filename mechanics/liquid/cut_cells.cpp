#include "mechanics/liquid/cut_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/liquid/cell_mean.hpp"
#include "mechanics/liquid/cut_walls.hpp"
#include "mechanics/liquid/junction_flux.hpp"
#include "mechanics/liquid/side_flux.hpp"
#include "mechanics/liquid/wall_level.hpp"

namespace mechanics::liquid {
namespace {

using convex::CutGrid;
using convex::CutPoint;
using convex::Index;

constexpr double unknown_pressure = std::numeric_limits<double>::quiet_NaN();
/// Links of a node at the boundary are cut no shorter than this part of a step.
constexpr double shortest_link = 1e-6;
std::size_t at(Index k) { return static_cast<std::size_t>(k); }

class Cutting {
 public:
  Cutting(const LiquidScene& scene, const std::array<Index, 3>& cells, const Window& window)
      : scene_(scene),
        domain_(scene.domain),
        d_(scene.dimension()),
        has_both_(scene.has_free_part() && scene.has_wall()),
        wall_level_(scene),
        cells_(cells) {
    made_.grid = CutGrid(d_, window.points);
    made_.first = window.first;
    made_.low = domain_.low;
    for (std::size_t i = 0; i < d_; ++i)
      made_.step[i] = (domain_.high[i] - domain_.low[i]) / static_cast<double>(cells[i]);
    const auto n = at(grid().size());
    made_.volume.assign(n, 0);
    made_.given.assign(n, unknown_pressure);
    made_.h.assign(n, 0);
    side_.assign(n, Side::outside);
  }

  CutCells cut() {
    find_sides();
    for_points([&](Index k) {
      if (side_[at(k)] == Side::inside) grid().kind[at(k)] = CutPoint::bounded;
      if (side_[at(k)] == Side::on) settle_boundary_point(k);
    });
    find_walls();
    if (has_both_) given_faces_.assign(side_.size(), Point{});
    for_points([&](Index k) {
      if (grid().is_unknown(k)) join(k);
    });
    hang_walls(made_, side_, normals_);
    if (has_both_) close_junctions(scene_, made_, std::move(given_faces_), normals_);
    CellMean source(scene_.h, domain_, made_, scene_.pressure_scale());
    for_points([&](Index k) {
      if (grid().is_unknown(k)) load(k, source);
    });
    made_.hidden = source.hidden();
    return std::move(made_);
  }

 private:
  CutGrid& grid() { return made_.grid; }

  template <class Work>
  void for_points(Work work) {
    const auto& n = grid().points;
    for (Index c = 0; c < n[2]; ++c)
      for (Index b = 0; b < n[1]; ++b)
        for (Index a = 0; a < n[0]; ++a) work(grid().at(a, b, c));
  }

  bool is_on_grid(Index k, std::size_t axis, int by) const {
    const Index i = made_.place(k)[axis] + by;
    return i >= 0 && i < made_.grid.points[axis];
  }

  void find_sides() {
    for_points([&](Index k) {
      const double level = domain_.level(made_.at(k)), reach = domain_.reach();
      side_[at(k)] = std::abs(level) <= reach ? Side::on : level < 0 ? Side::inside : Side::outside;
    });
  }

  /// The part of a boundary point; where parts meet at a point that none of them claims, a neighbour's.
  const BoundaryPart& part(const Point& x) const {
    if (const BoundaryPart* found = scene_.part_at(x)) return *found;
    for (std::size_t i = 0; i < d_; ++i)
      for (const double by : {-1e-6, 1e-6}) {
        Point near = x;
        near[i] += by * domain_.longest();
        if (std::abs(domain_.level(near)) > domain_.reach()) continue;
        if (const BoundaryPart* found = scene_.part_at(near)) return *found;
      }
    return scene_.boundary_part(x);
  }

  /// Where a wall ends at a free part p is what the free part gives: p is continuous.
  const BoundaryPart& part_or_free_beside(const Point& x) const {
    const BoundaryPart& found = part(x);
    if (found.is_free || !has_both_) return found;
    constexpr double beside = 0.01;  // of a step
    for (std::size_t i = 0; i < d_; ++i)
      for (const double by : {-beside, beside}) {
        Point near = x;
        near[i] += by * made_.step[i];
        if (std::abs(domain_.level(near)) > domain_.reach()) continue;
        if (const BoundaryPart* there = scene_.part_at(near); there != nullptr && there->is_free)
          return *there;
      }
    return found;
  }

  std::size_t number_of(const BoundaryPart& part) const { return at(&part - scene_.parts.data()); }

  void settle_boundary_point(Index k) {
    const Point x = made_.at(k);
    const BoundaryPart& found = part_or_free_beside(x);
    grid().kind[at(k)] = found.is_free ? CutPoint::fixed : CutPoint::bounded;
    if (!found.is_free) return;
    made_.given[at(k)] = scene_.free_pressure(found, x);
    made_.pressures.push_back({k, x, made_.given[at(k)], number_of(found)});
  }

  bool is_near_boundary(Index k) const {
    if (side_[at(k)] == Side::on) return true;
    const auto place = made_.place(k);
    std::array<Index, 3> by{};
    const auto reach = [&](std::size_t axis) { return axis < d_ ? Index{1} : Index{0}; };
    for (by[2] = -reach(2); by[2] <= reach(2); ++by[2])
      for (by[1] = -reach(1); by[1] <= reach(1); ++by[1])
        for (by[0] = -reach(0); by[0] <= reach(0); ++by[0]) {
          bool on_grid = true;
          for (std::size_t i = 0; i < d_; ++i)
            on_grid = on_grid && place[i] + by[i] >= 0 && place[i] + by[i] < made_.grid.points[i];
          if (!on_grid) continue;
          if (side_[at(made_.grid.at(place[0] + by[0], place[1] + by[1], place[2] + by[2]))] != side_[at(k)])
            return true;
        }
    return false;
  }

  double cell_volume() const { return made_.face_area(3); }

  /// The parts of the faces that are open, low and high by axis, of the cells near walls; volumes; pieces.
  void find_walls() {
    open_.assign(at(grid().size()), -1);
    for_points([&](Index k) {
      if (side_[at(k)] != Side::outside) made_.volume[at(k)] = cell_volume();
    });
    if (!scene_.has_wall()) return;
    for_points([&](Index k) {
      if (!is_near_boundary(k) || grid().kind[at(k)] == CutPoint::fixed) return;
      domain_.shape == Domain::Shape::box ? cut_box_cell(k) : cut_cell(k);
    });
  }

  struct Opening {
    std::array<double, 3> low{1, 1, 1}, high{1, 1, 1};
  };

  void keep(Index k, const Opening& opening) {
    open_[at(k)] = static_cast<std::ptrdiff_t>(openings_.size());
    openings_.push_back(opening);
  }

  /// Nodes lie on the sides of a box: cells there are halves, quarters or eighths.
  void cut_box_cell(Index k) {
    const auto place = made_.place(k);
    Opening opening;
    double part_of_volume = 1;
    std::array<int, 3> end{};  // which side of the box the node is on
    for (std::size_t i = 0; i < d_; ++i) {
      const Index whole = place[i] + made_.first[i];
      end[i] = whole == 0 ? -1 : whole == cells_[i] ? 1 : 0;
      if (end[i] == 0) continue;
      part_of_volume *= 0.5;
      (end[i] < 0 ? opening.low : opening.high)[i] = 0;
      for (std::size_t j = 0; j < d_; ++j)
        if (j != i) {
          opening.low[j] *= 0.5;
          opening.high[j] *= 0.5;
        }
    }
    made_.volume[at(k)] *= part_of_volume;
    for (std::size_t i = 0; i < d_; ++i) {
      if (end[i] == 0) continue;
      SidePiece piece{made_.at(k), made_.step, {}};
      piece.normal[i] = end[i];
      piece.extent[i] = 0;
      double area = made_.face_area(i);
      for (std::size_t j = 0; j < d_; ++j)
        if (j != i && end[j] != 0) {
          area *= 0.5;
          piece.extent[j] *= 0.5;
          piece.middle[j] -= 0.25 * end[j] * made_.step[j];
        }
      const BoundaryPart& found = part(piece.middle);
      if (!found.is_free)
        add_piece(k, found, {area, piece.middle, piece.normal}, side_flux(scene_, found, piece, made_.at(k)));
    }
    keep(k, opening);
  }

  void cut_cell(Index k) {
    Point low = made_.at(k);
    const Point x = low;
    for (std::size_t i = 0; i < d_; ++i) low[i] -= 0.5 * made_.step[i];
    const std::optional<WallCut> cut = wall_level_.cut(low, made_.step);
    if (!cut) return;
    keep(k, {cut->low, cut->high});
    if (side_[at(k)] == Side::outside) {
      // Beyond free parts nothing is; beyond a wall the rest of its cell is.
      if (!(cut->fraction > 0) || (cut->has_free && !wall_level_.is_beyond_wall(x))) return;
      grid().kind[at(k)] = CutPoint::free;
    }
    made_.volume[at(k)] = cut->fraction * cell_volume();
    for (const auto& [surface, wall] : cut->pieces)
      add_piece(k, *wall, surface, scene_.wall_flux(*wall, surface.at, surface.normal));
  }

  void add_piece(Index k, const BoundaryPart& wall, const SurfacePiece& surface, double flux) {
    made_.walls.push_back({k, -1, number_of(wall), surface.area, surface.area * flux, surface.at});
    normals_.push_back(surface.normal);
  }

  double opening(Index k, std::size_t axis) const {  // of the face towards the next point
    const Index next = k + made_.grid.stride(axis);
    if (open_[at(k)] >= 0) return openings_[at(open_[at(k)])].high[axis];
    return open_[at(next)] >= 0 ? openings_[at(open_[at(next)])].low[axis] : 1;
  }

  /// The links of an unknown to the next points, and what is given around it.
  void join(Index k) {
    for (std::size_t axis = 0; axis < d_; ++axis)
      for (const int by : {-1, 1}) {
        if (!is_on_grid(k, axis, by)) continue;
        const Index other = k + by * grid().stride(axis);
        const double weight = made_.face_area(axis) * opening(by > 0 ? k : other, axis) / made_.step[axis];
        if (!(weight > 0)) continue;
        bool is_given = true;
        if (grid().is_unknown(other) && !is_cut_by_free(k, other)) {
          if (by > 0) grid().link[axis][at(k)] = weight;
          is_given = false;
        } else if (grid().is_unknown(other)) {
          is_given = side_[at(k)] == Side::inside && join_cut(k, axis, other, weight);
        } else if (side_[at(other)] == Side::on) {
          give(k, weight, made_.given[at(other)]);
        } else {
          is_given = side_[at(k)] != Side::outside && join_cut(k, axis, other, weight);
        }
        if (has_both_ && is_given) given_faces_[at(k)][axis] += by * weight * made_.step[axis];
      }
  }

  /// Near a junction: two unknowns, of which a free part lies between.
  bool is_cut_by_free(Index k, Index other) const {
    if (side_[at(k)] != Side::inside) std::swap(k, other);
    if (!has_both_ || side_[at(k)] != Side::inside || side_[at(other)] != Side::outside) return false;
    return part(domain_.crossing(made_.at(k), made_.at(other))).is_free;
  }

  void give(Index k, double weight, double pressure) {
    grid().pull[at(k)] += weight;
    grid().load[at(k)] += weight * pressure;
  }

  bool join_cut(Index k, std::size_t axis, Index other, double weight) {
    Point from = made_.at(k), to = made_.at(other);
    if (side_[at(k)] == Side::on) {  // along a wall: just inside of it
      const Point n = domain_.outward(from);
      for (std::size_t i = 0; i < d_; ++i) {
        from[i] -= 1e-4 * made_.step[axis] * n[i];
        to[i] -= 1e-4 * made_.step[axis] * n[i];
      }
    }
    const Point x = domain_.crossing(from, to);
    const BoundaryPart& found = part(x);
    if (!found.is_free) return false;
    const double length = std::abs(x[axis] - from[axis]) / made_.step[axis];
    made_.pressures.push_back({k, x, scene_.free_pressure(found, x), number_of(found)});
    give(k, weight / std::max(length, shortest_link), made_.pressures.back().pressure);
    if (grid().kind[at(other)] == CutPoint::beyond) grid().kind[at(other)] = CutPoint::fixed;
    return true;
  }

  void load(Index k, CellMean& source) {
    Point x = made_.at(k);
    if (side_[at(k)] == Side::outside) x = domain_.foot(x);
    const double h = source(k, x);
    made_.h[at(k)] = h;
    grid().load[at(k)] += h * made_.volume[at(k)];
  }

  const LiquidScene& scene_;
  const Domain& domain_;
  std::size_t d_;
  bool has_both_ = false;  // free parts and walls
  WallLevel wall_level_;
  std::array<Index, 3> cells_;
  CutCells made_;
  std::vector<Side> side_;
  std::vector<std::ptrdiff_t> open_;
  std::vector<Opening> openings_;
  std::vector<Point> normals_;
  std::vector<Point> given_faces_;  // by point, the areas of faces to given pressures, outward
};

}  // namespace

double CutCells::face_area(std::size_t axis) const {
  double area = 1;
  for (std::size_t i = 0; i < grid.dimension; ++i)
    if (i != axis) area *= step[i];
  return area;
}

Point CutCells::at(Index k) const {
  const auto i = place(k);
  Point x{};
  for (std::size_t axis = 0; axis < grid.dimension; ++axis)
    x[axis] = low[axis] + step[axis] * static_cast<double>(first[axis] + i[axis]);
  return x;
}

std::array<Index, 3> CutCells::place(Index k) const {
  std::array<Index, 3> i{};
  for (std::size_t axis = grid.dimension; axis-- > 0;) {
    i[axis] = k / grid.stride(axis) - grid.frame(axis);
    k %= grid.stride(axis);
  }
  return i;
}

CutCells cut_cells(const LiquidScene& scene, const std::array<Index, 3>& cells) {
  Window whole;
  for (std::size_t i = 0; i < scene.dimension(); ++i) whole.points[i] = cells[i] + 1;
  return cut_cells(scene, cells, whole);
}

CutCells cut_cells(const LiquidScene& scene, const std::array<Index, 3>& cells, const Window& window) {
  return Cutting(scene, cells, window).cut();
}

}  // namespace mechanics::liquid
