#include "mechanics/liquid/cut_walls.hpp"

#include <algorithm>
#include <cmath>

namespace mechanics::liquid {
namespace {

using convex::CutPoint;
using convex::Index;

/// A cell beyond a wall that is open to the liquid by less of a face gives what it has to a neighbour.
constexpr double least_opening = 1e-5;

std::size_t index_at(Index k) { return static_cast<std::size_t>(k); }

class WallHanging {
 public:
  WallHanging(CutCells& cells, const std::vector<Side>& side, std::vector<Point>& normals)
      : cells_(cells), side_(side), normals_(normals), d_(cells.grid.dimension) {}

  /// Cells beyond walls that nothing of the liquid's side reaches, also through others, are taken out.
  void hang_all() {
    std::vector<bool> reached(index_at(grid().size()));
    std::vector<Index> from;
    for (Index k = 0; k < grid().size(); ++k)
      if (grid().kind[index_at(k)] == CutPoint::bounded) from.push_back(k);
    while (!from.empty()) {
      const Index k = from.back();
      from.pop_back();
      for (std::size_t axis = 0; axis < d_; ++axis)
        for (const int by : {-1, 1}) {
          const Index other = k + by * grid().stride(axis);
          const double open = grid().link[axis][index_at(by > 0 ? k : other)] * cells_.step[axis];
          if (grid().kind[index_at(other)] != CutPoint::free || reached[index_at(other)] ||
              open < least_opening * cells_.face_area(axis))
            continue;
          reached[index_at(other)] = true;
          from.push_back(other);
        }
    }
    for (Index k = 0; k < grid().size(); ++k) {
      if (grid().kind[index_at(k)] != CutPoint::free || reached[index_at(k)]) continue;
      grid().kind[index_at(k)] = CutPoint::beyond;
      for (std::size_t axis = 0; axis < d_; ++axis) {
        grid().link[axis][index_at(k)] = 0;
        grid().link[axis][index_at(k - grid().stride(axis))] = 0;
      }
    }
    std::vector<WallPiece> kept;
    std::vector<Point> kept_normals;
    for (std::size_t a = 0; a < cells_.walls.size(); ++a) {
      WallPiece piece = cells_.walls[a];
      const Index behind = nearest_inside(piece, normals_[a]);
      if (!grid().is_unknown(piece.point)) {
        if (behind < 0) continue;
        piece.point = behind;
      }
      hang(piece, normals_[a], behind);
      kept.push_back(piece);
      kept_normals.push_back(normals_[a]);
    }
    cells_.walls.swap(kept);
    normals_.swap(kept_normals);
  }

  double diagonal() const {
    return std::hypot(cells_.step[0], d_ > 1 ? cells_.step[1] : 0, d_ > 2 ? cells_.step[2] : 0);
  }

  double distance(Index k, const WallPiece& piece, const Point& normal) const {
    const Point x = cells_.at(k);
    double along = 0;
    for (std::size_t i = 0; i < d_; ++i) along += (piece.at[i] - x[i]) * normal[i];
    return along;
  }

  /// The node inside, within two steps of the piece's or itself, straight behind the wall; -1 where there is
  /// none.
  Index nearest_inside(const WallPiece& piece, const Point& normal) const {
    if (side_[index_at(piece.point)] != Side::outside) return piece.point;
    const Index near = straightest_inside(piece.point, normal, 1);
    return near >= 0 ? near : straightest_inside(piece.point, normal, 2);
  }

  Index straightest_inside(Index point, const Point& normal, Index reach) const {
    Index best = -1;
    double straightest = 0;
    const auto place = cells_.place(point);
    const auto of_axis = [&](std::size_t i) { return i < d_ ? reach : Index{0}; };
    std::array<Index, 3> by{};
    for (by[2] = -of_axis(2); by[2] <= of_axis(2); ++by[2])
      for (by[1] = -of_axis(1); by[1] <= of_axis(1); ++by[1])
        for (by[0] = -of_axis(0); by[0] <= of_axis(0); ++by[0]) {
          Index k = point;
          double along = 0, square = 0;
          bool is_there = true;
          for (std::size_t i = 0; i < d_; ++i) {
            const Index there = place[i] + by[i];
            is_there = is_there && there >= 0 && there < grid().points[i];
            k += by[i] * grid().stride(i);
            const double step = static_cast<double>(by[i]) * cells_.step[i];
            along -= step * normal[i];
            square += step * step;
          }
          if (!is_there || !(square > 0) || grid().kind[index_at(k)] != CutPoint::bounded) continue;
          if (along / std::sqrt(square) > straightest) {
            straightest = along / std::sqrt(square);
            best = k;
          }
        }
    return best;
  }

  /// The load of a piece, and its pendant where the node behind it is off the wall.
  void hang(WallPiece& piece, const Point& normal, Index behind) {
    grid().load[index_at(piece.point)] += piece.load;
    if (behind < 0 || side_[index_at(behind)] == Side::on || !(piece.area > 0)) return;
    const double away = std::max(distance(behind, piece, normal), 1e-3 * diagonal());
    piece.pendant = static_cast<std::ptrdiff_t>(grid().pendants.size());
    grid().pendants.push_back({behind, piece.area / away, piece.load / piece.area * away});
  }

 private:
  convex::CutGrid& grid() const { return cells_.grid; }
  CutCells& cells_;
  const std::vector<Side>& side_;
  std::vector<Point>& normals_;
  std::size_t d_;
};

}  // namespace

void hang_walls(CutCells& cells, const std::vector<Side>& side, std::vector<Point>& normals) {
  WallHanging(cells, side, normals).hang_all();
}

}  // namespace mechanics::liquid
