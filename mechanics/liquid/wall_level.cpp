#include "mechanics/liquid/wall_level.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/liquid/polygon.hpp"

namespace mechanics::liquid {
namespace {

/// Newton's steps along the gradient to the surface level = 0.
Point onto(const std::function<double(const Point&)>& level, Point x, std::size_t d, double scale) {
  for (int step = 0; step < 20; ++step) {
    const double value = level(x), width = 1e-6 * scale;
    Point slope{};
    double square = 0;
    for (std::size_t i = 0; i < d; ++i) {
      Point a = x, b = x;
      a[i] -= width;
      b[i] += width;
      slope[i] = (level(b) - level(a)) / (2 * width);
      square += slope[i] * slope[i];
    }
    if (!(square > 0) || value * value <= 1e-26 * scale * scale * square) break;
    for (std::size_t i = 0; i < d; ++i) x[i] -= value * slope[i] / square;
  }
  return x;
}

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// What of a piece of surface faces a boundary's outward normal, where the piece is part of what closes a
/// cell in which its wall ends.
SurfacePiece facing(SurfacePiece piece, const Point& normal) {
  piece.area *= piece.normal[0] * normal[0] + piece.normal[1] * normal[1] + piece.normal[2] * normal[2];
  piece.normal = normal;
  return piece;
}

}  // namespace

WallLevel::WallLevel(const LiquidScene& scene) : scene_(scene) {
  const Domain& domain = scene.domain;
  const std::size_t d = scene.dimension();
  const double scale = domain.longest();
  const auto smooth = [&](std::function<double(const Point&)> level) {
    sheets_.push_back({level, [level, d, scale](const Point& x) { return onto(level, x, d, scale); }});
  };
  if (domain.shape == Domain::Shape::polygon) {
    for (std::size_t k = 0; k < domain.vertices.size(); ++k) {
      const auto a = domain.vertices[k], b = domain.vertices[(k + 1) % domain.vertices.size()];
      const double ex = b[0] - a[0], ey = b[1] - a[1], length = std::hypot(ex, ey);
      sheets_.push_back({[=](const Point& x) { return ((x[0] - a[0]) * ey - (x[1] - a[1]) * ex) / length; },
                         [=](const Point& x) {
                           const double part = std::clamp(
                               ((x[0] - a[0]) * ex + (x[1] - a[1]) * ey) / (length * length), 0.0, 1.0);
                           return Point{a[0] + part * ex, a[1] + part * ey, 0};
                         }});
    }
  } else if (domain.condition) {
    for (const std::function<double(const Point&)>& level : domain.sheets) smooth(level);
  } else {
    smooth(domain.level);
  }
}

const BoundaryPart* WallLevel::part_near(const Point& x) const {
  const Point foot = scene_.domain.foot(x);
  return scene_.part_at(foot);
}

std::optional<WallCut> WallLevel::cut(const Point& low, const Point& step) const {
  if (scene_.domain.shape == Domain::Shape::polygon) return cut_polygon(low, step);
  CellLevels cell;
  cell.dimension = scene_.dimension();
  cell.low = low;
  cell.step = step;
  Point middle = low;
  double reach = 0;
  for (std::size_t i = 0; i < cell.dimension; ++i) {
    middle[i] += 0.5 * step[i];
    reach = std::hypot(reach, step[i]);
  }
  std::vector<Near> walls;
  std::vector<const Sheet*> cut_away;
  bool any_free = false;
  for (const Sheet& sheet : sheets_) {
    const Point foot = sheet.nearest(middle);
    if (distance(foot, middle) > 1.5 * reach) continue;
    if (scene_.domain.level(foot) > 1e-6 * reach) {  // off the domain: another sheet cuts it away
      cut_away.push_back(&sheet);
      continue;
    }
    const BoundaryPart* part = scene_.part_at(foot);
    if (part == nullptr) part = part_near(middle);
    if (part != nullptr && !part->is_free)
      walls.push_back({&sheet, part});
    else
      any_free = true;
  }
  if (walls.empty() && !any_free && !cut_away.empty())  // beyond an edge where these meet
    if (const BoundaryPart* part = part_near(middle); part != nullptr && !part->is_free)
      for (const Sheet* sheet : cut_away) walls.push_back({sheet, part});
  if (walls.empty()) return std::nullopt;
  bool turned = false;
  for (std::size_t code = 0; code < std::size_t{1} << cell.dimension; ++code) {
    Point x = low;
    for (std::size_t i = 0; i < cell.dimension; ++i)
      if ((code >> i & 1U) != 0) x[i] += step[i];
    double level = -std::numeric_limits<double>::infinity();
    if (any_free)
      for (const Near& wall : walls) level = std::max(level, wall.sheet->level(x));
    else
      level = scene_.domain.level(x);
    if (sheets_.size() == 1 && level > 0) {  // one sheet, free and wall: beyond free parts it is open
      const BoundaryPart* part = part_near(x);
      if (part != nullptr && part->is_free) {
        level = -level;
        turned = true;
      }
    }
    cell.at[code] = level == 0 ? -std::numeric_limits<double>::min() : level;
  }
  WallCut made;
  made.has_free = any_free || turned;
  made.fraction = cell.fraction();
  for (std::size_t i = 0; i < cell.dimension; ++i) {
    made.low[i] = cell.face_fraction(i, false);
    made.high[i] = cell.face_fraction(i, true);
  }
  for (SurfacePiece piece : cell.surface()) {
    const Near* nearest = &walls.front();
    for (const Near& wall : walls)
      if (std::abs(wall.sheet->level(piece.at)) < std::abs(nearest->sheet->level(piece.at))) nearest = &wall;
    const Point foot = nearest->sheet->nearest(piece.at);
    if (turned) piece = facing(piece, scene_.domain.outward(foot));
    if (!(piece.area > 0)) continue;
    const BoundaryPart* here = scene_.part_at(foot);
    made.pieces.push_back({piece, here != nullptr && !here->is_free ? here : nearest->wall});
  }
  return made;
}

namespace {

/// The part of the side a..b in the box, empty when low >= high. A side in a face of it, to `least`, is in
/// it.
std::pair<double, double> part_in_box(const Vertex& a, const Vertex& b, const Vertex& low, const Vertex& high,
                                      double least) {
  double first = 0, last = 1;
  for (std::size_t i = 0; i < 2; ++i) {
    const double along = b[i] - a[i];
    if (std::abs(along) < least) {
      if (a[i] < low[i] - least || a[i] > high[i] + least) return {1, 0};
      continue;
    }
    const double u = (low[i] - a[i]) / along, v = (high[i] - a[i]) / along;
    first = std::max(first, std::min(u, v));
    last = std::min(last, std::max(u, v));
  }
  return {first, last};
}

}  // namespace

/// In a cell that free sides cross too, walls are the lines of their sides.
std::optional<WallCut> WallLevel::cut_polygon(const Point& low, const Point& step) const {
  const std::vector<Vertex>& v = scene_.domain.vertices;
  const Vertex a{low[0], low[1]}, b{low[0] + step[0], low[1] + step[1]};
  const double least = 1e-9 * std::min(step[0], step[1]);
  struct Crossing {
    Vertex from, to, normal;
    const BoundaryPart* part;
  };
  // The axis and the direction of the face of the cell in which a side lies.
  const auto face_of = [&](const Crossing& side) -> std::optional<std::pair<std::size_t, int>> {
    for (std::size_t i = 0; i < 2; ++i)
      for (const int by : {-1, 1}) {
        const double limit = by < 0 ? a[i] : b[i];
        if (std::abs(side.from[i] - limit) < least && std::abs(side.to[i] - limit) < least)
          return std::pair{i, by};
      }
    return std::nullopt;
  };
  std::vector<Crossing> walls;
  bool any_free = false;
  for (std::size_t k = 0; k < v.size(); ++k) {
    const Vertex &p = v[k], &q = v[(k + 1) % v.size()];
    const auto [first, last] = part_in_box(p, q, a, b, least);
    const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
    if (!((last - first) * length > least)) continue;
    const auto at = [&](double part) {
      return Vertex{p[0] + part * (q[0] - p[0]), p[1] + part * (q[1] - p[1])};
    };
    const Crossing side{at(first), at(last), {(q[1] - p[1]) / length, (p[0] - q[0]) / length}, nullptr};
    if (const auto face = face_of(side); face && side.normal[face->first] * face->second < 0)
      continue;  // the liquid is in the cell beside this one
    const Vertex middle = at(0.5 * (first + last));
    const BoundaryPart& part = scene_.boundary_part({middle[0], middle[1], 0});
    any_free = any_free || part.is_free;
    if (!part.is_free) walls.push_back({side.from, side.to, side.normal, &part});
  }
  if (walls.empty()) return std::nullopt;
  std::vector<Vertex> rest = any_free ? std::vector<Vertex>{a, {b[0], a[1]}, b, {a[0], b[1]}} : v;
  if (any_free)
    for (const Crossing& wall : walls)
      rest = cut_off(rest, [&](const Vertex& x) {
        const double excess = (x[0] - wall.from[0]) * wall.normal[0] + (x[1] - wall.from[1]) * wall.normal[1];
        return std::abs(excess) < least ? 0 : excess;
      });
  else
    for (std::size_t i = 0; i < 2; ++i) {
      rest = cut_off(rest, [&](const Vertex& x) { return a[i] - x[i]; });
      rest = cut_off(rest, [&](const Vertex& x) { return x[i] - b[i]; });
    }
  WallCut made;
  made.has_free = any_free;
  made.fraction = rest.size() < 3 ? 0 : polygon_area(rest) / (step[0] * step[1]);
  made.low = made.high = {0, 0, 0};
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const Vertex &p = rest[k], &q = rest[(k + 1) % rest.size()];
    const double dx = (q[0] - p[0]) / step[0], dy = (q[1] - p[1]) / step[1];
    const auto on = [&](std::size_t i, double limit) {
      return std::abs(p[i] - limit) < least && std::abs(q[i] - limit) < least;
    };
    if (on(0, a[0])) made.low[0] -= dy;
    if (on(0, b[0])) made.high[0] += dy;
    if (on(1, a[1])) made.low[1] += dx;
    if (on(1, b[1])) made.high[1] -= dx;
  }
  for (const Crossing& wall : walls) {
    Vertex from = wall.from, to = wall.to;
    if (any_free) {  // what of the wall's line bounds the rest of the cell
      for (std::size_t k = 0; k < rest.size(); ++k) {
        const Vertex &p = rest[k], &q = rest[(k + 1) % rest.size()];
        const auto off = [&](const Vertex& x) {
          return std::abs((x[0] - wall.from[0]) * wall.normal[0] + (x[1] - wall.from[1]) * wall.normal[1]);
        };
        if (off(p) < least && off(q) < least && std::hypot(q[0] - p[0], q[1] - p[1]) > least) {
          from = p;
          to = q;
        }
      }
    }
    const double area = std::hypot(to[0] - from[0], to[1] - from[1]);
    if (const auto face = face_of({from, to, wall.normal, wall.part}))  // closed by the wall itself
      (face->second < 0 ? made.low : made.high)[face->first] -= area / step[1 - face->first];
    made.pieces.push_back(
        {{area, {0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]), 0}, {wall.normal[0], wall.normal[1], 0}},
         wall.part});
  }
  return made;
}

bool WallLevel::is_beyond_wall(const Point& x) const {
  const BoundaryPart* part = part_near(x);
  return part != nullptr && !part->is_free;
}

}  // namespace mechanics::liquid
