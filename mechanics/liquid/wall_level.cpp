#include "mechanics/liquid/wall_level.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

bool WallLevel::fill(CellLevels& cell) const {
  const std::size_t d = cell.dimension, corners = std::size_t{1} << d;
  Point middle = cell.low;
  double reach = 0;
  for (std::size_t i = 0; i < d; ++i) {
    middle[i] += 0.5 * cell.step[i];
    reach = std::hypot(reach, cell.step[i]);
  }
  std::vector<const Sheet*> walls;
  bool any_free = false;
  for (const Sheet& sheet : sheets_) {
    const Point foot = sheet.nearest(middle);
    if (distance(foot, middle) > 1.5 * reach) continue;
    if (scene_.domain.level(foot) > 1e-6 * reach) continue;  // off the domain: another sheet cuts it away
    const BoundaryPart* part = scene_.part_at(foot);
    if (part == nullptr) part = part_near(middle);
    (part != nullptr && !part->is_free) ? walls.push_back(&sheet) : void(any_free = true);
  }
  if (walls.empty()) return false;
  for (std::size_t code = 0; code < corners; ++code) {
    Point x = cell.low;
    for (std::size_t i = 0; i < d; ++i)
      if ((code >> i & 1U) != 0) x[i] += cell.step[i];
    double level = -std::numeric_limits<double>::infinity();
    if (any_free)
      for (const Sheet* sheet : walls) level = std::max(level, sheet->level(x));
    else
      level = scene_.domain.level(x);
    if (sheets_.size() == 1 && level > 0) {  // one sheet, free and wall: beyond free parts it is open
      const BoundaryPart* part = part_near(x);
      if (part != nullptr && part->is_free) level = -level;
    }
    cell.at[code] = level == 0 ? -std::numeric_limits<double>::min() : level;
  }
  return true;
}

bool WallLevel::is_beyond_wall(const Point& x) const {
  const BoundaryPart* part = part_near(x);
  return part != nullptr && !part->is_free;
}

const BoundaryPart* WallLevel::wall_at(const Point& x) const {
  const BoundaryPart* part = part_near(x);
  return part != nullptr && !part->is_free ? part : nullptr;
}

}  // namespace mechanics::liquid
