#include "cli/drawing/liquid_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace cli {
namespace {

using mechanics::liquid::BoundaryPart;
using mechanics::liquid::LiquidScene;
using mechanics::liquid::LiquidSolution;
using SpacePoint = mechanics::liquid::Point;

constexpr int pixels_of_field = 240, hatches = 40;

/// The section that is drawn: the first two coordinates, the third at the middle of the domain.
class Section {
 public:
  Section(const LiquidScene& scene, const LiquidSolution& found) : scene_(scene), found_(found) {
    if (scene.dimension() == 3) height_ = 0.5 * (scene.domain.low[2] + scene.domain.high[2]);
    step_ = std::max(side(0), side(1)) / pixels_of_field;
  }
  double side(std::size_t i) const { return scene_.domain.high[i] - scene_.domain.low[i]; }
  double low(std::size_t i) const { return scene_.domain.low[i]; }
  SpacePoint at(double x, double y) const { return {x, y, height_}; }
  double height() const { return height_; }
  double step() const { return step_; }
  bool is_inside(const SpacePoint& x) const { return scene_.domain.level(x) <= scene_.domain.reach(); }

  /// Lines of equal y apart by empty lines; nothing is drawn where p is NaN.
  std::string field() const {
    std::string text;
    const int nx = count(0), ny = count(1);
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        const SpacePoint x = at(low(0) + side(0) * i / nx, low(1) + side(1) * j / ny);
        if (is_inside(x))
          fmt::format_to(std::back_inserter(text), "{} {} {}\n", x[0], x[1],
                         found_.in_cavity(x) ? 0.0 : found_.p(x));
        else
          fmt::format_to(std::back_inserter(text), "{} {} NaN\n", x[0], x[1]);
      }
      text += "\n";
    }
    return text;
  }

  /// The parts of lines x - y = c that lie in the cavity, as gnuplot's vectors.
  std::string hatching() const {
    std::string text;
    const double apart = (side(0) + side(1)) / hatches;
    for (double c = low(0) - low(1) - side(1) + apart / 2; c < low(0) - low(1) + side(0); c += apart) {
      bool drawing = false;
      double begin = 0;
      const auto end_at = [&](double x) {
        if (drawing)
          fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", begin, begin - c, x - begin, x - begin);
        drawing = false;
      };
      for (double x = low(0); x <= low(0) + side(0) + step_ / 2; x += step_ / 2) {
        const SpacePoint here = at(x, x - c);
        const bool hatched = is_inside(here) && found_.in_cavity(here);
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

  /// Points of the walls that part, where p = 0.
  std::string parted() const {
    std::string text;
    const int nx = count(0), ny = count(1);
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        const SpacePoint x = at(low(0) + side(0) * i / nx, low(1) + side(1) * j / ny);
        if (!is_inside(x)) continue;
        const SpacePoint foot = scene_.domain.foot(x);
        if (std::hypot(foot[0] - x[0], foot[1] - x[1], foot[2] - x[2]) > 0.8 * step_) continue;
        const BoundaryPart* part = scene_.part_at(foot);
        if (part == nullptr || part->is_free || found_.p(foot) > 1e-3 * found_.largest) continue;
        const auto& names = found_.parted_walls;
        if (std::find(names.begin(), names.end(), part->name) == names.end()) continue;
        fmt::format_to(std::back_inserter(text), "{} {}\n", foot[0], foot[1]);
      }
    return text;
  }

 private:
  int count(std::size_t i) const { return std::max(1, static_cast<int>(std::lround(side(i) / step_))); }
  const LiquidScene& scene_;
  const LiquidSolution& found_;
  double height_ = 0, step_ = 1;
};

std::string liquid_title(const LiquidSolution& found) {
  std::string text = "pressure, at most " + fmt::format("{:.4g}", found.largest);
  if (found.cavity_measure > 0) text += "; hatched: the cavity";
  if (!found.parted_walls.empty()) text += "; red: walls that part";
  return text;
}

Drawing liquid_line_drawing(const LiquidScene& scene, const LiquidSolution& found) {
  constexpr int points = 1000;
  std::string curve, cavity;
  for (int k = 0; k <= points; ++k) {
    const double x = scene.domain.low[0] + (scene.domain.high[0] - scene.domain.low[0]) * k / points;
    if (scene.domain.level({x, 0, 0}) > scene.domain.reach()) continue;
    const bool in_cavity = found.in_cavity({x, 0, 0});
    fmt::format_to(std::back_inserter(curve), "{} {}\n", x, in_cavity ? 0.0 : found.p({x, 0, 0}));
    if (in_cavity) fmt::format_to(std::back_inserter(cavity), "{} {}\n", x, found.largest);
  }
  const bool hatched = !cavity.empty();
  std::string parted;  // the ends at which the liquid leaves a wall, clear of the frame
  for (const double x : {scene.domain.low[0], scene.domain.high[0]}) {
    const BoundaryPart* part = scene.part_at({x, 0, 0});
    const auto& names = found.parted_walls;
    if (part != nullptr && std::find(names.begin(), names.end(), part->name) != names.end())
      fmt::format_to(std::back_inserter(parted), "{} 0\n", x);
  }
  const double room = 0.02 * (scene.domain.high[0] - scene.domain.low[0]);
  return {"$p << END\n" + curve + "END\n" + (hatched ? "$cavity << END\n" + cavity + "END\n" : "") +
              (parted.empty() ? "" : "$parted << END\n" + parted + "END\n") +
              fmt::format(
                  "set title {}\nset xlabel {}\nset ylabel 'p'\nset xrange [{}:{}]\nset yrange [0:*]\nunset "
                  "key\nplot {}$p with lines lw 2 lc rgb '#0060a0'{}\n",
                  cli::quoted(liquid_title(found)), cli::quoted(scene.coordinates[0]),
                  scene.domain.low[0] - room, scene.domain.high[0] + room,
                  hatched ? "$cavity with filledcurves y1=0 fs transparent pattern 5 lc rgb '#808080', " : "",
                  parted.empty() ? "" : ", $parted with points pt 7 ps 1.2 lc rgb '#d00000'"),
          420};
}

}  // namespace

Drawing liquid_drawing(const LiquidScene& scene, const LiquidSolution& found) {
  if (scene.dimension() == 1) return liquid_line_drawing(scene, found);
  const Section section(scene, found);
  std::string script = "$p << END\n" + section.field() + "END\n";
  const std::string hatching = section.hatching(), parted = section.parted();
  if (!hatching.empty()) script += "$hatching << END\n" + hatching + "END\n";
  if (!parted.empty()) script += "$parted << END\n" + parted + "END\n";
  script +=
      "set contour base\nset cntrparam levels auto 12\nunset surface\nset table $contours\nsplot $p using "
      "1:2:3 with lines "
      "nosurface\nunset table\nset surface\nunset contour\n";
  std::string heading = liquid_title(found);
  if (scene.dimension() == 3)
    heading += fmt::format("; section {} = {:.4g}", scene.coordinates[2], section.height());
  const double room = 0.03 * std::max(section.side(0), section.side(1));
  script += fmt::format(
      "set title {}\nset xlabel {}\nset ylabel {}\nset size ratio -1\nunset key\nset tics out\nset xrange "
      "[{}:{}]\nset "
      "yrange [{}:{}]\nset cblabel 'p'\nset rmargin 10\nset palette defined (0 '#ffffff', 0.3 '#c6dbef', 0.7 "
      "'#6baed6', 1 "
      "'#2171b5')\nset cbrange [0:{}]\n",
      cli::quoted(heading), cli::quoted(scene.coordinates[0]), cli::quoted(scene.coordinates[1]),
      section.low(0) - room, section.low(0) + section.side(0) + room, section.low(1) - room,
      section.low(1) + section.side(1) + room, std::max(found.largest, 1e-300));
  script += "plot $p using 1:2:3 with image pixels, $contours using 1:2 with lines lc rgb '#505050' lw 0.7";
  if (!hatching.empty()) script += ", $hatching using 1:2:3:4 with vectors nohead lc rgb '#303030' lw 0.8";
  if (!parted.empty()) script += ", $parted using 1:2 with points pt 7 ps 0.35 lc rgb '#d00000'";
  return {script + "\n", 640};
}

}  // namespace cli
