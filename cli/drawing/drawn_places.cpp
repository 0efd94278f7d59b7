#include "cli/drawing/drawn_places.hpp"

#include <algorithm>
#include <cmath>

namespace cli::inline drawings {
namespace {

using convex::Index;
using convex::Vector;
using Point = Eigen::Vector2d;

/// Of the size of the drawing: what is drawn no farther apart touches.
constexpr double near_part = 1e-6;

Point point_at(const Vector& values, Index x, Index y) { return {values[x], values[y]}; }

/// Where on the line from a to b the point is nearest, 0 at a and 1 at b.
double nearest_part(const Point& a, const Point& b, const Point& p) {
  const double squared = (b - a).squaredNorm();
  return squared > 0 ? (p - a).dot(b - a) / squared : 0;
}

}  // namespace

PlacesOfScene::PlacesOfScene(const DrawnScene& scene) : scene_(scene) {
  for (const DrawnScene::Shape& shape : scene.shapes()) {
    const std::vector<Index>& number = shape.numbers;
    named_.push_back({number[0], number[1], shape.kind == DrawnShape::Kind::circle ? number[2] : Index(-1)});
    if (shape.kind != DrawnShape::Kind::segment) continue;
    named_.push_back({number[2], number[3]});
    segments_.push_back({number[0], number[1], number[2], number[3]});
  }
}

double PlacesOfScene::along(const DrawnPlace& place, const Vector& values) const {
  if (place.end_x < 0) return 0;
  const DrawnPlace& other = named_[place.touching];
  return std::clamp(
      nearest_part(point_at(values, place.x, place.y), point_at(values, place.end_x, place.end_y),
                   point_at(values, other.x, other.y)),
      0.0, 1.0);
}

double PlacesOfScene::nearness(const Vector& values) const {
  if (named_.empty()) return 0;
  Point low = point_at(values, named_[0].x, named_[0].y), high = low;
  for (const DrawnPlace& place : named_) {
    const Point p = point_at(values, place.x, place.y);
    const double radius = place.radius < 0 ? 0 : values[place.radius];
    low = low.cwiseMin(Point(p.array() - radius));
    high = high.cwiseMax(Point(p.array() + radius));
  }
  return near_part * (high - low).maxCoeff();
}

DrawnPlaces PlacesOfScene::touched(const Vector& values) const {
  const double near = nearness(values);
  DrawnPlaces found;
  for (const auto& [x, y, end_x, end_y] : segments_) {
    const Point a = point_at(values, x, y), b = point_at(values, end_x, end_y);
    for (std::size_t k = 0; k < named_.size(); ++k) {
      const DrawnPlace& place = named_[k];
      const Point p = point_at(values, place.x, place.y);
      const double part = nearest_part(a, b, p), radius = place.radius < 0 ? 0 : values[place.radius];
      const Point foot = a + part * (b - a);
      const bool is_between = part > 0 && part < 1 && (foot - a).norm() > near && (b - foot).norm() > near;
      if (is_between && std::abs((p - foot).norm() - radius) <= near)
        found.push_back({x, y, -1, end_x, end_y, k});
    }
  }
  return found;
}

convex::SparseRows PlacesOfScene::derivatives(const DrawnPlaces& places,
                                              const mechanics::State& state) const {
  std::vector<Index> numbers;
  for (const DrawnPlace& place : places)
    for (const Index k : {place.x, place.y, place.end_x, place.end_y})
      if (k >= 0) numbers.push_back(k);
  return scene_.derivatives(state, numbers);
}

DrawnPlaces PlacesOfScene::moved_with(const Vector& u, const DrawnPlaces& places,
                                      const convex::SparseRows& J) {
  DrawnPlaces found;
  Index row = 0;
  for (const DrawnPlace& place : places) {
    bool meets = false;
    for (const Index end = row + (place.end_x < 0 ? 2 : 4); row < end; ++row)
      for (convex::SparseRows::InnerIterator entry(J, row); entry; ++entry)
        meets = meets || (entry.value() != 0 && u[entry.col()] != 0);
    if (meets) found.push_back(place);
  }
  return found;
}

std::vector<PlacesOfScene::Spot> PlacesOfScene::spots(const DrawnPlaces& places,
                                                      const mechanics::State& state,
                                                      const Vector& values) const {
  const convex::SparseRows J = derivatives(places, state);
  std::vector<Spot> made;
  Index row = 0;
  for (const DrawnPlace& place : places) {
    const double part = along(place, values);
    Spot spot{point_at(values, place.x, place.y), convex::Matrix(state.q.size(), 2)};
    for (Index i = 0; i < 2; ++i) spot.columns.col(i) = Vector(J.row(row++).transpose());
    if (place.end_x >= 0) {
      spot.p += part * (point_at(values, place.end_x, place.end_y) - spot.p);
      for (Index i = 0; i < 2; ++i)
        spot.columns.col(i) = (1 - part) * spot.columns.col(i) + part * Vector(J.row(row++).transpose());
    }
    made.push_back(std::move(spot));
  }
  return made;
}

bool PlacesOfScene::is_on_ground(const Spot& at, const mechanics::State& state, const Vector& values) const {
  const double near = nearness(values);
  DrawnPlaces beside;
  for (const DrawnPlace& place : named_)
    if (place.radius < 0 && (point_at(values, place.x, place.y) - at.p).norm() <= near)
      beside.push_back(place);
  for (const auto& [x, y, end_x, end_y] : segments_) {
    const Point a = point_at(values, x, y), b = point_at(values, end_x, end_y);
    const double part = nearest_part(a, b, at.p);
    if (part < 0 || part > 1 || (a + part * (b - a) - at.p).norm() > near) continue;
    const std::vector<Spot> ends = spots({{x, y}, {end_x, end_y}}, state, values);
    if (ends[0].columns.isZero(0) && ends[1].columns.isZero(0)) return true;
  }
  const std::vector<Spot> found = spots(beside, state, values);
  return std::any_of(found.begin(), found.end(), [](const Spot& spot) { return spot.columns.isZero(0); });
}

}  // namespace cli::inline drawings
