#include "mechanics/liquid/continuity.hpp"

#include <algorithm>
#include <cmath>

#include "convex/invalid_input.hpp"

namespace mechanics::liquid {
namespace {

/// Lines across each axis, and points along them.
constexpr std::array<int, 3> lines_of_search{1, 48, 12};
constexpr int points_of_search = 192;
/// A change this large within what doubles can separate, of the largest value seen on the line, is a jump.
constexpr double jump_part = 1e-6;

/// The place of a jump between two points of a line, if there is one: halving, towards the larger change.
std::optional<Point> jump_between(const Field& field, Point a, Point b, std::size_t axis, double scale) {
  double low = field.raw(a), high = field.raw(b);
  constexpr int halvings = 60;
  for (int halving = 0; halving < halvings; ++halving) {
    if (!(std::abs(high - low) > jump_part * scale)) return std::nullopt;
    Point middle = a;
    middle[axis] = 0.5 * (a[axis] + b[axis]);
    if (middle[axis] == a[axis] || middle[axis] == b[axis]) return a;
    const double value = field.raw(middle);
    if (std::abs(value - low) > std::abs(high - value)) {
      b = middle;
      high = value;
    } else {
      a = middle;
      low = value;
    }
  }
  return a;
}

void search_line(const LiquidScene& scene, const Field& field, const char* what, Point from,
                 std::size_t axis) {
  const Domain& domain = scene.domain;
  const double step = (domain.high[axis] - domain.low[axis]) / points_of_search;
  std::array<double, points_of_search> values{};
  std::array<bool, points_of_search> inside{};
  double scale = 0;
  const auto at = [&](std::size_t k) {
    Point x = from;
    x[axis] = domain.low[axis] + (static_cast<double>(k) + 0.5) * step;
    return x;
  };
  for (std::size_t k = 0; k < values.size(); ++k) {
    inside[k] = domain.level(at(k)) < 0;
    values[k] = inside[k] ? field.raw(at(k)) : 0;
    scale = std::max(scale, std::abs(values[k]));
  }
  for (std::size_t k = 0; k + 1 < values.size(); ++k) {
    if (!inside[k] || !inside[k + 1]) continue;
    if (auto jump = jump_between(field, at(k), at(k + 1), axis, scale)) {
      // Halving ends a few roundings of a step beside a jump at 0.
      if (std::abs((*jump)[axis]) < 1e-15 * step) (*jump)[axis] = 0;
      throw convex::InvalidInput(std::string(what) + ": it jumps at " + point_text(scene.coordinates, *jump) +
                                     ", so that h is not a function there; give one without jumps",
                                 field.place());
    }
  }
}

void search(const LiquidScene& scene, const Field& field, const char* what, std::size_t axis) {
  if (!field.may_jump()) return;
  const std::size_t d = scene.dimension();
  const int lines = lines_of_search[d - 1];
  const Domain& domain = scene.domain;
  const auto place = [&](std::size_t i, int k) {
    return domain.low[i] + (domain.high[i] - domain.low[i]) * (k + 0.5) / lines;
  };
  for (int j = 0; j < (d > 1 ? lines : 1); ++j)
    for (int k = 0; k < (d > 2 ? lines : 1); ++k) {
      Point from{};
      if (d > 1) from[(axis + 1) % d] = place((axis + 1) % d, j);
      if (d > 2) from[(axis + 2) % d] = place((axis + 2) % d, k);
      search_line(scene, field, what, from, axis);
    }
}

}  // namespace

void require_continuous(const LiquidScene& scene) {
  for (std::size_t axis = 0; axis < scene.dimension(); ++axis) {
    for (const Field& component : scene.velocity) search(scene, component, "velocity", axis);
    if (!scene.force.empty()) search(scene, scene.force[axis], "force", axis);
  }
}

}  // namespace mechanics::liquid
