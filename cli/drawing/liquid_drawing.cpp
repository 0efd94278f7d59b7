#include "cli/drawing/liquid_drawing.hpp"

#include "cli/drawing/label_placement.hpp"
#include "cli/drawing/liquid_section.hpp"
#include "convex/invalid_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace cli::inline drawings {
namespace {

using mechanics::liquid::BoundaryPart;
using mechanics::liquid::LiquidScene;
using mechanics::liquid::LiquidSolution;

std::string liquid_title(const LiquidSolution& found, const std::string& title) {
  constexpr double room = 600;
  std::string text = (title.empty() ? "" : heading_line(title, room) + "\n") + "pressure, at most " +
                     fmt::format("{:.4g}", found.largest);
  if (found.cavity_measure > 0) text += "; hatched: the cavity";
  if (!found.parted_walls.empty()) text += "; red: walls that part";
  return text;
}

/// Between contours: 1, 2 or 5 times a power of ten, so that there are twelve at most. They are counted from
/// 0, not from the least p that is seen: where p is one number but for rounding, its noise has none.
double between_contours(double largest) {
  constexpr double most_contours = 12;
  const double least = largest / most_contours, decade = std::pow(10, std::floor(std::log10(least)));
  for (const double part : {1.0, 2.0, 5.0})
    if (part * decade >= least) return part * decade;
  return 10 * decade;
}

Drawing liquid_line_drawing(const LiquidScene& scene, const LiquidSolution& found, const std::string& title) {
  constexpr int points = 1000;
  std::string curve, cavity;
  for (int k = 0; k <= points; ++k) {
    const double x = scene.domain.low[0] + (scene.domain.high[0] - scene.domain.low[0]) * k / points;
    if (scene.domain.level({x, 0, 0}) > scene.domain.reach()) continue;
    const bool in_cavity = found.in_cavity({x, 0, 0});
    curve += fmt::format("{} {}\n", x, in_cavity ? 0.0 : found.p({x, 0, 0}));
    if (in_cavity) cavity += fmt::format("{} {}\n", x, found.largest);
  }
  const bool hatched = !cavity.empty();
  std::string parted;  // the ends at which the liquid leaves a wall, clear of the frame
  for (const double x : {scene.domain.low[0], scene.domain.high[0]}) {
    const BoundaryPart* part = scene.part_at({x, 0, 0});
    const auto& names = found.parted_walls;
    if (part != nullptr && std::find(names.begin(), names.end(), part->name) != names.end())
      parted += fmt::format("{} 0\n", x);
  }
  const double room = 0.02 * (scene.domain.high[0] - scene.domain.low[0]);
  return {"$p << END\n" + curve + "END\n" + (hatched ? "$cavity << END\n" + cavity + "END\n" : "") +
              (parted.empty() ? "" : "$parted << END\n" + parted + "END\n") +
              fmt::format(
                  "set title {}\nset xlabel {}\nset ylabel 'p'\nset xrange [{}:{}]\nset yrange [0:*]\nunset "
                  "key\nplot {}$p with lines lw 2 lc rgb '#0060a0'{}\n",
                  cli::quoted(liquid_title(found, title)), cli::quoted(scene.coordinates[0]),
                  scene.domain.low[0] - room, scene.domain.high[0] + room,
                  hatched ? "$cavity with filledcurves y1=0 fs transparent pattern 5 lc rgb '#808080', " : "",
                  parted.empty() ? "" : ", $parted with points pt 7 ps 1.2 lc rgb '#d00000'"),
          420};
}

}  // namespace

Drawing liquid_drawing(const LiquidScene& scene, const LiquidSolution& found, const std::string& title,
                       bool with_velocity, const std::optional<std::string>& plane) {
  const SectionAxes axes = plane ? section_axes(scene.coordinates, *plane) : most_telling_axes(scene, found);
  if (scene.dimension() == 1) {
    if (with_velocity)
      throw convex::InvalidInput(
          "--velocity: arrows are drawn in two or three dimensions; leave it out of a picture of one");
    return liquid_line_drawing(scene, found, title);
  }
  const LiquidSection section(scene, found, axes);
  std::string script = "$p << END\n" + section.field() + "END\n";
  const std::string hatching = section.hatching(), outline = section.outline();
  script += "$border << END\n" + section.border() + "END\n";
  std::string parted;
  for (const mechanics::liquid::Point& x : section.parted()) parted += fmt::format("{} {}\n", x[0], x[1]);
  const LiquidSection::Arrows arrows = with_velocity ? section.velocity() : LiquidSection::Arrows{};
  if (!arrows.vectors.empty()) script += "$velocity << END\n" + arrows.vectors + "END\n";
  if (!hatching.empty())
    script += "$hatching << END\n" + hatching + "END\n$outline << END\n" + outline + "END\n";
  if (!parted.empty()) script += "$parted << END\n" + parted + "END\n";
  const double between = between_contours(std::max(found.largest, 1e-300));
  constexpr double below_largest = 1 - 1e-6;
  script += fmt::format(
      "set contour base\nset cntrparam levels incremental {},{},{}\nunset surface\nset table "
      "$contours\nsplot $p "
      "using 1:2:3 with lines nosurface\nunset table\nset surface\nunset contour\n",
      between, between, below_largest * found.largest);
  std::string heading = liquid_title(found, title);
  if (found.largest > 0) heading += fmt::format("; contours every {:g}", between);
  const bool is_cut = scene.dimension() == 3;  // what goes across the section is no arrow in it
  if (is_cut) heading += fmt::format("; section {} = {:.4g}", scene.coordinates[axes[2]], section.height());
  if (arrows.fastest > 0)
    heading += fmt::format("\narrows: the velocity{}, the longest {:.4g}", is_cut ? " along the section" : "",
                           arrows.fastest);
  else if (with_velocity)
    heading += is_cut ? "\nno velocity along the section" : "\nthe velocity is 0";
  const double room = 0.03 * std::max(section.side(0), section.side(1));
  script += fmt::format(
      "set title {}\nset xlabel {}\nset ylabel {}\nset size ratio -1\nunset key\nset tics out\nset xrange "
      "[{}:{}]\nset "
      "yrange [{}:{}]\nset label 'p' at graph 1.065,1 center offset 0,0.8\nset rmargin 10\nset palette "
      "defined (0 '#ffffff', 0.3 '#c6dbef', 0.7 "
      "'#6baed6', 1 "
      "'#2171b5')\nset cbrange [0:{}]\n",
      cli::quoted(heading), cli::quoted(scene.coordinates[axes[0]]), cli::quoted(scene.coordinates[axes[1]]),
      section.low(0) - room, section.low(0) + section.side(0) + room, section.low(1) - room,
      section.low(1) + section.side(1) + room, found.largest > 0 ? found.largest : 1);
  script += "plot $p using 1:2:3 with image, $contours using 1:2 with lines lc rgb '#505050' lw 0.7";
  if (!hatching.empty()) script += ", $hatching using 1:2:3:4 with vectors nohead lc rgb '#303030' lw 0.8";
  if (!hatching.empty() && !outline.empty())
    script += ", $outline using 1:2:3:4 with vectors nohead lc rgb '#303030' lw 1.5";
  script += ", $border using 1:2:3:4 with vectors nohead lc rgb '#202020' lw 1.6";
  if (!parted.empty()) script += ", $parted using 1:2 with points pt 7 ps 0.35 lc rgb '#d00000'";
  if (!arrows.vectors.empty())
    script += ", $velocity using 1:2:3:4 with vectors head size screen 0.008,25 filled lc rgb '#b05000' lw 1";
  // Of the frame as wide as the page leaves it, with what is around.
  constexpr double frame_width = 500, around = 130, least = 260, most = 900;
  const double height = around + frame_width * section.side(1) / section.side(0);
  return {script + "\n", static_cast<int>(std::clamp(height, least, most))};
}

}  // namespace cli::inline drawings
