#include "cli/drawing/liquid_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline drawings {

using mechanics::liquid::BoundaryPart;
using mechanics::liquid::LiquidScene;
using mechanics::liquid::LiquidSolution;
using SectionPoint = mechanics::liquid::Point;

namespace {

constexpr int pixels_of_field = 480, hatches = 80, arrows_along_side = 20;

}  // namespace

SectionAxes section_axes(const std::vector<std::string>& coordinates, const std::string& plane) {
  const auto fail = [&](const std::string& why) -> SectionAxes {
    throw convex::InvalidInput("--plane " + plane + ": " + why);
  };
  if (coordinates.size() < 3) return fail("the liquid has no third coordinate; leave --plane out");
  const std::size_t comma = plane.find(',');
  if (comma == std::string::npos)
    return fail("not two coordinates; write --plane " + coordinates[0] + "," + coordinates[2]);
  const auto index = [&](const std::string& name) {
    const auto found = std::find(coordinates.begin(), coordinates.end(), name);
    if (found == coordinates.end())
      fail("no coordinate \"" + name + "\"; " + convex::suggestion(name, coordinates));
    return static_cast<std::size_t>(found - coordinates.begin());
  };
  const std::size_t first = index(plane.substr(0, comma)), second = index(plane.substr(comma + 1));
  if (first == second) return fail("twice the same coordinate; name two");
  return {first, second, 3 - first - second};
}

SectionAxes most_telling_axes(const LiquidScene& scene, const LiquidSolution& found) {
  SectionAxes chosen{0, 1, 2};
  if (scene.dimension() < 3) return chosen;
  constexpr double clearly = 1.1;
  double most = clearly * LiquidSection(scene, found, chosen).spread();
  for (const SectionAxes& axes : {SectionAxes{0, 2, 1}, SectionAxes{1, 2, 0}})
    if (const double spread = LiquidSection(scene, found, axes).spread(); spread > most) {
      chosen = axes;
      most = clearly * spread;
    }
  return chosen;
}

LiquidSection::LiquidSection(const LiquidScene& scene, const LiquidSolution& found, SectionAxes axes)
    : scene_(scene), found_(found), axes_(axes) {
  if (scene.dimension() == 3) height_ = 0.5 * (scene.domain.low[axes[2]] + scene.domain.high[axes[2]]);
  step_ = std::max(side(0), side(1)) / pixels_of_field;
}

double LiquidSection::side(std::size_t i) const {
  return scene_.domain.high[axes_[i]] - scene_.domain.low[axes_[i]];
}
double LiquidSection::low(std::size_t i) const { return scene_.domain.low[axes_[i]]; }

SectionPoint LiquidSection::in_space(const SectionPoint& x) const {
  SectionPoint made{};
  for (std::size_t i = 0; i < axes_.size(); ++i) made[axes_[i]] = x[i];
  return made;
}

SectionPoint LiquidSection::in_section(const SectionPoint& x) const {
  SectionPoint made{};
  for (std::size_t i = 0; i < axes_.size(); ++i) made[i] = x[axes_[i]];
  return made;
}

bool LiquidSection::is_inside(const SectionPoint& x) const {
  return scene_.domain.level(in_space(x)) <= scene_.domain.reach();
}

bool LiquidSection::in_cavity(const SectionPoint& x) const { return found_.in_cavity(in_space(x)); }

int LiquidSection::count(std::size_t i) const {
  return std::max(1, static_cast<int>(std::lround(side(i) / step_)));
}

double LiquidSection::spread() const {
  constexpr int points = 16;
  double least = found_.largest, most = 0;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j) {
      const SectionPoint x = at(low(0) + side(0) * (i + 0.5) / points, low(1) + side(1) * (j + 0.5) / points);
      if (!is_inside(x)) continue;
      const double p = in_cavity(x) ? 0.0 : found_.p(in_space(x));
      least = std::min(least, p);
      most = std::max(most, p);
    }
  return std::max(0.0, most - least);
}

std::string LiquidSection::field() const {
  std::string text;
  const int nx = count(0), ny = count(1);
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const SectionPoint x = at(low(0) + side(0) * i / nx, low(1) + side(1) * j / ny);
      if (is_inside(x))
        text += fmt::format("{} {} {}\n", x[0], x[1], in_cavity(x) ? 0.0 : found_.p(in_space(x)));
      else
        text += fmt::format("{} {} NaN\n", x[0], x[1]);
    }
    text += "\n";
  }
  return text;
}

std::string LiquidSection::hatching() const {
  std::string text;
  const double apart = (side(0) + side(1)) / hatches;
  for (double c = low(0) - low(1) - side(1) + apart / 2; c < low(0) - low(1) + side(0); c += apart) {
    bool drawing = false;
    double begin = 0;
    const auto end_at = [&](double x) {
      if (drawing) text += fmt::format("{} {} {} {}\n", begin, begin - c, x - begin, x - begin);
      drawing = false;
    };
    for (double x = low(0); x <= low(0) + side(0) + step_ / 2; x += step_ / 2) {
      const SectionPoint here = at(x, x - c);
      const bool hatched = is_inside(here) && in_cavity(here);
      if (hatched && !drawing) {
        drawing = true;
        begin = x;
      }
      if (!hatched) end_at(x - step_ / 2);
    }
    end_at(low(0) + side(0));
  }
  return text;
}

SectionPoint LiquidSection::edge_between(SectionPoint in, SectionPoint out) const {
  constexpr int halvings = 8;
  for (int k = 0; k < halvings; ++k) {
    const SectionPoint middle = at(0.5 * (in[0] + out[0]), 0.5 * (in[1] + out[1]));
    (in_cavity(middle) ? in : out) = middle;
  }
  return at(0.5 * (in[0] + out[0]), 0.5 * (in[1] + out[1]));
}

std::string LiquidSection::edge(int nx, int ny, const std::function<Side(const SectionPoint&)>& side_of,
                                const Between& between) const {
  std::string text;
  const auto node = [&](int i, int j) { return at(low(0) + side(0) * i / nx, low(1) + side(1) * j / ny); };
  std::vector<Side> sides;
  for (int j = -1; j <= ny + 1; ++j)
    for (int i = -1; i <= nx + 1; ++i) sides.push_back(side_of(node(i, j)));
  const auto side_at = [&](int i, int j) {
    return sides[static_cast<std::size_t>((j + 1) * (nx + 3) + i + 1)];
  };
  for (int j = -1; j <= ny; ++j)
    for (int i = -1; i <= nx; ++i) {
      constexpr std::array<std::array<int, 2>, 5> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
      std::vector<SectionPoint> crossed;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto &a = around[k], &b = around[k + 1];
        const Side here = side_at(i + a[0], j + a[1]), there = side_at(i + b[0], j + b[1]);
        if (here == Side::none || there == Side::none || here == there) continue;
        const SectionPoint x = node(i + a[0], j + a[1]), y = node(i + b[0], j + b[1]);
        crossed.push_back(here == Side::in ? between(x, y) : between(y, x));
      }
      for (std::size_t k = 0; k + 1 < crossed.size(); k += 2)
        text += fmt::format("{} {} {} {}\n", crossed[k][0], crossed[k][1], crossed[k + 1][0] - crossed[k][0],
                            crossed[k + 1][1] - crossed[k][1]);
    }
  return text;
}

std::string LiquidSection::outline() const {
  return edge(
      count(0) / 2 + 1, count(1) / 2 + 1,
      [this](const SectionPoint& x) {
        return !is_inside(x) ? Side::none : in_cavity(x) ? Side::in : Side::out;
      },
      [this](const SectionPoint& in, const SectionPoint& out) { return edge_between(in, out); });
}

std::string LiquidSection::border() const {
  return edge(
      count(0), count(1), [this](const SectionPoint& x) { return is_inside(x) ? Side::in : Side::out; },
      [this](const SectionPoint& in, const SectionPoint& out) {
        return in_section(scene_.domain.crossing(in_space(in), in_space(out)));
      });
}

std::vector<SectionPoint> LiquidSection::parted() const {
  std::vector<SectionPoint> points;
  const auto& names = found_.parted_walls;
  if (names.empty()) return points;
  const int nx = count(0), ny = count(1);
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const SectionPoint x = at(low(0) + side(0) * i / nx, low(1) + side(1) * j / ny);
      if (!is_inside(x)) continue;
      const SectionPoint there = scene_.domain.foot(in_space(x)), foot = in_section(there);
      if (std::hypot(foot[0] - x[0], foot[1] - x[1], foot[2] - x[2]) > 0.8 * step_) continue;
      const BoundaryPart* part = scene_.part_at(there);
      if (part == nullptr || part->is_free || !(found_.p(there) <= 1e-3 * found_.largest)) continue;
      if (std::find(names.begin(), names.end(), part->name) == names.end()) continue;
      if (!scene_.wall_leaves(*part, there)) continue;
      points.push_back(foot);
    }
  return points;
}

LiquidSection::Arrows LiquidSection::velocity() const {
  Arrows arrows;
  if (scene_.velocity.empty()) return arrows;
  // Evenly over each side, half a step off its ends, so that the picture is as symmetric as the domain.
  const auto along = [&](std::size_t i) {
    const double apart = std::max(side(0), side(1)) / arrows_along_side;
    return std::max(1, static_cast<int>(std::lround(side(i) / apart)));
  };
  const int nx = along(0), ny = along(1);
  const double apart = std::min(side(0) / nx, side(1) / ny);
  std::vector<std::array<double, 4>> drawn;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const double x = low(0) + side(0) * (i + 0.5) / nx, y = low(1) + side(1) * (j + 0.5) / ny;
      const SectionPoint here = at(x, y);
      if (!is_inside(here)) continue;
      const SectionPoint there = in_space(here);
      const double u = scene_.velocity[axes_[0]].raw(there), v = scene_.velocity[axes_[1]].raw(there);
      if (!std::isfinite(u) || !std::isfinite(v)) continue;
      drawn.push_back({x, y, u, v});
      arrows.fastest = std::max(arrows.fastest, std::hypot(u, v));
    }
  for (const auto& [x, y, u, v] : drawn) {
    if (!(std::hypot(u, v) > 0)) continue;
    const double dx = apart * (u / arrows.fastest), dy = apart * (v / arrows.fastest);
    arrows.vectors += fmt::format("{} {} {} {}\n", x - dx / 2, y - dy / 2, dx, dy);
  }
  return arrows;
}

}  // namespace cli::inline drawings
