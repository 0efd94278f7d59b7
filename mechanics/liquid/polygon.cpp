#include "mechanics/liquid/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mechanics::liquid {
namespace {

double cross(const Vertex& a, const Vertex& b, const Vertex& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool sides_meet(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
  const double u = cross(a, b, c), v = cross(a, b, d), s = cross(c, d, a), t = cross(c, d, b);
  return ((u > 0 && v < 0) || (u < 0 && v > 0)) && ((s > 0 && t < 0) || (s < 0 && t > 0));
}

double distance(const Vertex& a, const Vertex& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

/// The point of the side from a to b nearest to x.
Vertex foot_on(const Vertex& a, const Vertex& b, const Vertex& x) {
  const double ex = b[0] - a[0], ey = b[1] - a[1];
  const double part = std::clamp(((x[0] - a[0]) * ex + (x[1] - a[1]) * ey) / (ex * ex + ey * ey), 0.0, 1.0);
  return {a[0] + part * ex, a[1] + part * ey};
}

}  // namespace

double polygon_area(const std::vector<Vertex>& v) {
  double twice = 0;
  for (std::size_t k = 0; k < v.size(); ++k) {
    const Vertex &a = v[k], &b = v[(k + 1) % v.size()];
    twice += (a[0] - v[0][0]) * (b[1] - v[0][1]) - (b[0] - v[0][0]) * (a[1] - v[0][1]);
  }
  return twice / 2;
}

std::string arrange(std::vector<Vertex>& v) {
  v.erase(std::unique(v.begin(), v.end()), v.end());
  if (v.size() > 1 && v.front() == v.back()) v.pop_back();
  if (v.size() < 3) return "fewer than three different ones; give them in order";
  const double area = polygon_area(v);
  if (area == 0) return "the polygon is empty, its area is 0; give vertices in order";
  if (area < 0) std::reverse(v.begin(), v.end());
  for (std::size_t i = 0; i < v.size(); ++i)
    for (std::size_t j = i + 1; j < v.size(); ++j)
      if (sides_meet(v[i], v[(i + 1) % v.size()], v[j], v[(j + 1) % v.size()]))
        return "two sides cross; give them in order";
  return "";
}

double polygon_level(const std::vector<Vertex>& v, const Vertex& x) {
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (std::size_t k = 0; k < v.size(); ++k) {
    const Vertex &a = v[k], &b = v[(k + 1) % v.size()];
    const double ex = b[0] - a[0], ey = b[1] - a[1], wx = x[0] - a[0], wy = x[1] - a[1];
    const double part = std::clamp((wx * ex + wy * ey) / (ex * ex + ey * ey), 0.0, 1.0);
    nearest = std::min(nearest, std::hypot(wx - part * ex, wy - part * ey));
    if ((a[1] > x[1]) != (b[1] > x[1]) && (cross(a, b, x) > 0) == (b[1] > a[1])) inside = !inside;
  }
  return inside ? -nearest : nearest;
}

std::vector<Vertex> cut_off(const std::vector<Vertex>& v,
                            const std::function<double(const Vertex&)>& excess) {
  std::vector<Vertex> kept;
  for (std::size_t k = 0; k < v.size(); ++k) {
    const Vertex &a = v[k], &b = v[(k + 1) % v.size()];
    const double f = excess(a), g = excess(b);
    if (f <= 0) kept.push_back(a);
    if ((f < 0 && g > 0) || (f > 0 && g < 0)) {
      const double part = f / (f - g);
      kept.push_back({a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])});
    }
  }
  return kept;
}

std::optional<Vertex> narrow_place(const std::vector<Vertex>& v, double width) {
  constexpr double detour = 4, strip = 0.125, most_steps = 4096;
  std::vector<double> along{0};
  for (std::size_t k = 0; k < v.size(); ++k)
    along.push_back(along.back() + distance(v[k], v[(k + 1) % v.size()]));
  const double whole = along.back();
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vertex &from = v[i], &to = v[(i + 1) % v.size()];
    const double length = along[i + 1] - along[i],
                 pieces = std::clamp(std::ceil(length / width), 1.0, most_steps);
    for (double piece = 0; piece < pieces; ++piece) {
      const double part = piece / pieces;
      const Vertex x{from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])};
      for (std::size_t k = 0; k < v.size(); ++k) {
        if (k == i || (piece == 0 && (k + 1) % v.size() == i)) continue;
        const Vertex foot = foot_on(v[k], v[(k + 1) % v.size()], x);
        const double gap = distance(x, foot);
        if (!(gap < width)) continue;
        const double way = std::abs(along[k] + distance(v[k], foot) - along[i] - part * length),
                     path = std::min(way, whole - way);
        if (path >= strip * whole || (piece == 0 && path >= detour * gap))
          return Vertex{0.5 * (x[0] + foot[0]), 0.5 * (x[1] + foot[1])};
      }
    }
  }
  return std::nullopt;
}

Vertex polygon_foot(const std::vector<Vertex>& v, const Vertex& x) {
  Vertex best = v[0];
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < v.size(); ++k) {
    const Vertex foot = foot_on(v[k], v[(k + 1) % v.size()], x);
    if (const double here = distance(x, foot); here < nearest) {
      nearest = here;
      best = foot;
    }
  }
  return best;
}

}  // namespace mechanics::liquid
