#include "convex/atlas/plane_map.hpp"

#include <algorithm>

#include "convex/atlas/dropping_rule.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/invalid_input.hpp"

namespace convex::atlas {
namespace {

/// a·p + b >= 0 in the parameters.
struct HalfPlane {
  std::vector<Fraction> a;
  Fraction b;
};

Fraction value(const HalfPlane& half, const ParameterPoint& p) {
  Fraction sum = half.b;
  for (std::size_t k = 0; k < p.size(); ++k) sum = sum + half.a[k] * p[k];
  return sum;
}

/// Where the boundary is crossed, between two points on either side of it.
ParameterPoint crossing(const ParameterPoint& p, const Fraction& here, const ParameterPoint& q,
                        const Fraction& there) {
  const Fraction part = here / (here - there);
  ParameterPoint between;
  for (std::size_t k = 0; k < p.size(); ++k) between.push_back(p[k] + part * (q[k] - p[k]));
  return between;
}

/// The part of a polygon, or of an interval, in the half-plane (Sutherland and Hodgman 1974).
void cut(std::vector<ParameterPoint>& corners, const HalfPlane& half) {
  std::vector<ParameterPoint> kept;
  const std::size_t count = corners.size();
  for (std::size_t k = 0; k < count; ++k) {
    const ParameterPoint &p = corners[k], &q = corners[(k + 1) % count];
    const Fraction here = value(half, p), there = value(half, q);
    if (sign(here) >= 0) kept.push_back(p);
    if (sign(here) * sign(there) < 0 && (p.size() == 2 || k == 0))
      kept.push_back(crossing(p, here, q, there));
  }
  corners = std::move(kept);
}

ParameterPolygon measured(std::vector<ParameterPoint> corners) {
  ParameterPolygon polygon{std::move(corners), {0, 1}};
  const auto& c = polygon.corners;
  if (c.empty()) return polygon;
  if (c.front().size() == 1) {
    const auto [low, high] = std::minmax_element(
        c.begin(), c.end(), [](const ParameterPoint& p, const ParameterPoint& q) { return p[0] < q[0]; });
    polygon.area = (*high)[0] - (*low)[0];
    polygon.corners = {*low, *high};
    return polygon;
  }
  for (std::size_t k = 0; k < c.size(); ++k) {
    const ParameterPoint &p = c[k], &q = c[(k + 1) % c.size()];
    polygon.area = polygon.area + p[0] * q[1] - q[0] * p[1];
  }
  polygon.area = polygon.area / Fraction{2, 1};
  return polygon;
}

std::vector<ParameterPoint> rectangle(const Parameters& parameters) {
  const auto &low = parameters.low, &high = parameters.high;
  if (low.size() == 1) return {{low[0]}, {high[0]}};
  return {{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}};
}

/// form·(c, 1) as it depends on the parameters.
HalfPlane half_plane(const RowSpace& space, const Parameters& parameters, const IntegerVector& form) {
  IntegerVector covector(static_cast<std::size_t>(space.n), 0);
  for (std::size_t k = 0; k < space.rank; ++k)
    for (std::size_t i = 0; i < covector.size(); ++i) covector[i] += form[k] * space.free_rows[k][i];
  const auto at_point = [&](const ExactVector& z) {
    return space.factor * Fraction{dot(covector, z.numerators), z.denominator};
  };
  HalfPlane half{{}, at_point(parameters.origin) + Fraction{form.back(), 1}};
  for (const ExactVector& direction : parameters.directions) half.a.push_back(at_point(direction));
  return half;
}

}  // namespace

std::vector<PlaneRegion> plane_map(const Atlas& whole, const Parameters& parameters) {
  const std::size_t count = parameters.directions.size();
  if (count < 1 || count > 2) throw InvalidInput("a map has one or two parameters");
  for (std::size_t k = 0; k < count; ++k)
    if (!(parameters.low[k] < parameters.high[k]))
      throw InvalidInput("a parameter of a map runs from a lower to a higher value");
  std::vector<HalfPlane> walls;
  for (const Wall& wall : whole.walls) walls.push_back(half_plane(whole.space, parameters, wall.form));
  std::vector<PlaneRegion> regions;
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    std::vector<ParameterPoint> corners = rectangle(parameters);
    for (const std::size_t w : whole.cells[c].walls) {
      HalfPlane half = walls[w];
      const bool within = sign(half.b) == 0 && std::all_of(half.a.begin(), half.a.end(),
                                                           [](const Fraction& x) { return sign(x) == 0; });
      // A plane that lies in the wall: there the answer has equality in the rows of the tighter cell.
      if (within && whole.walls[w].looser == c) corners.clear();
      if (whole.walls[w].tighter == c) {
        half.b = -half.b;
        for (Fraction& entry : half.a) entry = -entry;
      }
      cut(corners, half);
    }
    PlaneRegion region{c, measured(std::move(corners)), std::nullopt};
    if (sign(region.polygon.area) <= 0) continue;
    if (rule_is_defined(whole)) {
      std::vector<ParameterPoint> right = region.polygon.corners;
      if (whole.cells[c].rows.size() < whole.space.count())
        for (const IntegerVector& form : kept_by_rule(whole, c))
          cut(right, half_plane(whole.space, parameters, form));
      region.right = measured(std::move(right));
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace convex::atlas
