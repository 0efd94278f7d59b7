#include "cli/drawing/atlas_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/drawing/labelled_page.hpp"
#include "convex/exact/fraction_arithmetic.hpp"
#include "mechanics/gauss_solution.hpp"

namespace cli::inline drawings {
namespace {

using convex::atlas::ParameterPolygon;
using convex::atlas::PlaneRegion;

/// Pale, apart in grey too (Okabe and Ito 2008, lightened).
constexpr std::array region_colours{"#ffffff", "#fbd9a5", "#bfe0f5", "#a9dcc8", "#f7f2ae",
                                    "#a9c7dd", "#eec1a3", "#e6c6d8", "#c8c8c8", "#8fb8a8"};
constexpr int map_height = 520, map_width = 840;
/// Regions of a smaller part of the map have no arrows; the longest arrow is such a part of its width.
constexpr double least_part = 0.02, longest_arrow = 0.12;

Eigen::Vector2d corner_at(const ParameterPolygon& polygon, std::size_t k) {
  return {convex::nearest_double(polygon.corners[k][0]), convex::nearest_double(polygon.corners[k][1])};
}

/// A data block of the polygon, closed.
std::string block(const std::string& name, const ParameterPolygon& polygon) {
  std::string text = "$" + name + " << EOD\n";
  for (std::size_t k = 0; k <= polygon.corners.size(); ++k) {
    const Eigen::Vector2d p = corner_at(polygon, k % polygon.corners.size());
    text += fmt::format("{} {}\n", p.x(), p.y());
  }
  return text + "EOD\n";
}

/// The centre of mass.
Eigen::Vector2d centre(const ParameterPolygon& polygon) {
  const Eigen::Vector2d first = corner_at(polygon, 0);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double area = 0;
  for (std::size_t k = 1; k + 1 < polygon.corners.size(); ++k) {
    const Eigen::Vector2d p = corner_at(polygon, k) - first, q = corner_at(polygon, k + 1) - first;
    const double part = p.x() * q.y() - p.y() * q.x();
    sum += part / 3 * (p + q);
    area += part;
  }
  return first + sum / area;
}

/// Free and true acceleration at a point of the map, in the two coordinates.
struct ArrowPair {
  Eigen::Vector2d at, free, truth;
};

ArrowPair arrows_at(const AtlasMap& map, const Scene& scene, const Eigen::Vector2d& p) {
  convex::NearestPointProblem problem = scene.problem;
  for (std::size_t k = 0; k < 2; ++k)
    problem.z[static_cast<convex::Index>(map.over[k].coordinate)] += p[static_cast<convex::Index>(k)];
  const convex::Vector free = problem.A.solve(problem.z), truth = mechanics::solve(problem).primal.q;
  const auto x = static_cast<convex::Index>(map.over[0].coordinate),
             y = static_cast<convex::Index>(map.over[1].coordinate);
  return {p, {free[x], free[y]}, {truth[x], truth[y]}};
}

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The contacts that persist; of most of them those that do not. Beyond the room of the key, how many.
std::string region_name(const SolvedAtlas& solved, const PlaneRegion& region) {
  constexpr std::size_t longest = 46;
  const std::vector<std::string> held = solved.names(solved.atlas.cells[region.cell]);
  if (held.empty()) return "no contact";
  const std::string all = joined_names(held);
  if (all.size() <= longest) return all;
  std::vector<std::string> others;
  for (const std::string& name : solved.contacts)
    if (std::find(held.begin(), held.end(), name) == held.end()) others.push_back(name);
  if (others.empty()) return fmt::format("all {} contacts", held.size());
  const std::string rest = "all but " + joined_names(others);
  if (rest.size() <= longest) return rest;
  return fmt::format("{}, … ({} of {})", all.substr(0, all.rfind(", ", longest - 14)), held.size(),
                     solved.contacts.size());
}

/// Two regions that would read alike are told apart by their number in the list of cells.
std::vector<std::string> region_names(const SolvedAtlas& solved, const std::vector<PlaneRegion>& regions) {
  std::vector<std::string> names;
  for (const PlaneRegion& region : regions) names.push_back(region_name(solved, region));
  std::vector<std::string> told = names;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (std::count(names.begin(), names.end(), names[k]) > 1)
      told[k] += fmt::format(", cell {}", regions[k].cell + 1);
  return told;
}

}  // namespace

Drawing atlas_drawing(const SolvedAtlas& solved, const Scene& scene) {
  const AtlasMap& map = *solved.map;
  std::string data, plots;
  const auto plot = [&](const std::string& text) { plots += (plots.empty() ? "plot " : ", \\\n  ") + text; };
  bool hatched = false;
  std::vector<ArrowPair> pairs;
  const std::vector<std::string> titles = region_names(solved, map.regions);
  for (std::size_t k = 0; k < map.regions.size(); ++k) {
    const PlaneRegion& region = map.regions[k];
    const std::string name = fmt::format("region{}", k), right = fmt::format("right{}", k);
    const char* colour = region_colours[k % region_colours.size()];
    data += block(name, region.polygon);
    plot(fmt::format(
        "${} with filledcurves closed fs solid 1 border lc rgb \"#888888\" fc rgb \"{}\" title {}", name,
        colour, quoted(titles[k])));
    if (region.right && region.right->area < region.polygon.area) {
      hatched = true;
      plot(fmt::format(
          "${} with filledcurves closed fs transparent pattern 4 noborder fc rgb \"#777777\" notitle", name));
      if (sign(region.right->area) > 0) {
        data += block(right, *region.right);
        plot(fmt::format("${} with filledcurves closed fs solid 1 noborder fc rgb \"{}\" notitle", right,
                         colour));
      }
    }
    plot(fmt::format("${} with lines lc rgb \"#555555\" lw 0.8 notitle", name));
    if (convex::nearest_double(region.polygon.area) >= least_part * map.area())
      pairs.push_back(arrows_at(map, scene, centre(region.polygon)));
  }
  const auto bound = [](const convex::Fraction& x) { return convex::nearest_double(x); };
  const bool shows_file = sign(map.over[0].low) <= 0 && sign(map.over[0].high) >= 0 &&
                          sign(map.over[1].low) <= 0 && sign(map.over[1].high) >= 0;
  if (shows_file) {
    pairs.push_back(arrows_at(map, scene, {0, 0}));
    plot(
        "\"+\" using (0):(0) every ::0::0 with points pt 7 ps 0.7 lc rgb \"#000000\" title \"the force of "
        "the file\"");
  }
  Eigen::Vector2d longest = Eigen::Vector2d::Zero();
  for (const ArrowPair& pair : pairs)
    longest = longest.cwiseMax(pair.free.cwiseAbs()).cwiseMax(pair.truth.cwiseAbs());
  for (double& length : longest) length = length > 0 ? length : 1;
  std::string arrows;
  const Eigen::Vector2d low(bound(map.over[0].low), bound(map.over[1].low)),
      high(bound(map.over[0].high), bound(map.over[1].high));
  const auto arrow = [&](const ArrowPair& pair, const Eigen::Vector2d& vector, const char* style) {
    const Eigen::Vector2d drawn = longest_arrow * vector.cwiseQuotient(longest);
    constexpr double seen = 1e-3;
    if (drawn.norm() < seen) return;
    // Where the tip would leave the frame, it stands at the point instead.
    const Eigen::Vector2d tip = (pair.at - low).cwiseQuotient(high - low) + drawn;
    const bool is_inside = tip.minCoeff() > 0 && tip.maxCoeff() < 1;
    const Eigen::Vector2d from =
        is_inside ? pair.at : Eigen::Vector2d(pair.at - drawn.cwiseProduct(high - low));
    arrows += fmt::format("set arrow from {},{} rto graph {},{} front {}\n", from.x(), from.y(), drawn.x(),
                          drawn.y(), style);
  };
  for (const ArrowPair& pair : pairs) {
    arrow(pair, pair.free, "lc rgb \"#d55e00\" lw 1.6 size screen 0.012,20");
    arrow(pair, pair.truth, "lc rgb \"#0072b2\" lw 2.4 size screen 0.012,20");
  }
  plot("NaN with lines lc rgb \"#d55e00\" lw 1.6 title \"free acceleration A⁻¹z\"");
  plot("NaN with lines lc rgb \"#0072b2\" lw 2.4 title \"true acceleration\"");
  if (hatched)
    plot(
        "NaN with boxes fs pattern 4 border lc rgb \"#777777\" fc rgb \"#777777\" title "
        "\"dropping negatives is wrong\"");
  Drawing made;
  made.height = map_height;
  made.width = map_width;
  made.script =
      data + arrows +
      fmt::format(
          "set lmargin at screen 0.13\nset rmargin at screen 0.62\nset tmargin at screen 0.93\n"
          "set bmargin at screen 0.12\nset xrange [{}:{}]\nset yrange [{}:{}]\nset title {} font \",11\"\n"
          "set xlabel {} font \",10\"\nset ylabel {} font \",10\"\nset border 15 lc rgb \"#666666\" lw 0.7\n"
          "set tics nomirror out font \",9\"\nset key at screen 0.64,0.94 left top Left reverse font \",9\" "
          "samplen "
          "1.5\n",
          bound(map.over[0].low), bound(map.over[0].high), bound(map.over[1].low), bound(map.over[1].high),
          quoted(heading_line(solved.title.empty() ? solved.file : solved.title)),
          quoted(map.over[0].key + ", added"), quoted(map.over[1].key + ", added")) +
      plots + "\n";
  return made;
}

}  // namespace cli::inline drawings
