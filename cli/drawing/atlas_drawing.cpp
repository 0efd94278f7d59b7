#include "cli/drawing/atlas_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "cli/drawing/contact_sets.hpp"
#include "cli/drawing/label_placement.hpp"
#include "cli/drawing/stacked_diagrams.hpp"
#include "cli/report/text_table.hpp"
#include "convex/exact/fraction_arithmetic.hpp"
#include "mechanics/gauss_solution.hpp"

namespace cli::inline drawings {
namespace {

using convex::atlas::ParameterPolygon;
using convex::atlas::PlaneRegion;

/// Pixels: the map between the numbers of its axes and the key.
constexpr double map_left = 109, map_right = 521, map_frame = 416, map_above = 52, map_below = 62,
                 map_key = 537;
/// Regions of a smaller part of the map have no arrows; the longest arrow is such a part of its width, and at
/// least that where it would end beyond the map.
constexpr double least_part = 0.02, longest_arrow = 0.12, least_arrow = 0.05;

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

/// Two regions that would read alike are told apart by their number in the list of cells.
std::vector<std::string> region_names(const SolvedAtlas& solved, const std::vector<PlaneRegion>& regions) {
  std::vector<std::string> names, numbers;
  for (const PlaneRegion& region : regions) {
    names.push_back(contact_set_name(solved.names(solved.atlas.cells[region.cell]), solved.contacts));
    numbers.push_back(fmt::format("cell {}", region.cell + 1));
  }
  return told_apart(names, numbers);
}

/// The fill of each region. Where there are more than fills, the smallest share the last.
std::vector<std::size_t> region_fills(const std::vector<PlaneRegion>& regions) {
  std::vector<std::size_t> order(regions.size()), fills(regions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (regions.size() > most_fills)
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
      return regions[j].polygon.area < regions[i].polygon.area;
    });
  for (std::size_t k = 0; k < order.size(); ++k) fills[order[k]] = std::min(k, most_fills - 1);
  return fills;
}

/// Pairs of arrows as they are drawn: to one scale of the kinetic metric, in which a length and an angle have
/// one, so that they point where the two components together lead.
class ArrowsOnMap {
 public:
  /// `scale`: of each component. `shape`: the map's width and height in one unit.
  ArrowsOnMap(const std::vector<ArrowPair>& pairs, const Eigen::Vector2d& scale, const Eigen::Vector2d& shape,
              const Eigen::Vector2d& low, const Eigen::Vector2d& high)
      : pairs_(pairs), per_unit_((high - low).cwiseProduct(scale).cwiseQuotient(shape)), size_(high - low) {
    double longest = std::numeric_limits<double>::min();  // all are 0 there
    for (const ArrowPair& pair : pairs)
      for (const Eigen::Vector2d& vector : {pair.free, pair.truth}) {
        longest_ = longest_.cwiseMax(vector.cwiseAbs());
        longest = std::max(longest, vector.cwiseProduct(scale).norm());
      }
    factor_ = longest_arrow * shape.x() / longest;
    // Each begins where its force is, and ends on the map where it can.
    const double least = least_arrow / longest_arrow * factor_;
    for (const ArrowPair& pair : pairs)
      for (const Eigen::Vector2d& vector : {pair.free, pair.truth})
        for (Eigen::Index k = 0; k < 2; ++k) {
          const double room = vector[k] < 0 ? pair.at[k] - low[k] : high[k] - pair.at[k];
          const double step = std::abs(vector[k]) * per_unit_[k];
          if (factor_ * step > room) factor_ = std::max(least, room / step);
        }
  }
  const Eigen::Vector2d& longest() const { return longest_; }
  /// The true acceleration is thin on the free one, on white, so that both are seen where they are one.
  std::string script() const {
    std::string text;
    for (const ArrowPair& pair : pairs_) {
      text += arrow(pair.at, pair.free, "lc rgb \"#d55e00\" lw 4.6", 0.017, "28");
      text += arrow(pair.at, pair.truth, "lc rgb \"#ffffff\" lw 2.6", 0.012, "16 filled");
      text += arrow(pair.at, pair.truth, "lc rgb \"#0072b2\" lw 1.6", 0.012, "16 filled");
    }
    return text;
  }

 private:
  /// `head`: the length of its head, as a part of the page, and its form.
  std::string arrow(const Eigen::Vector2d& from, const Eigen::Vector2d& vector, const char* line, double head,
                    const char* form) const {
    const Eigen::Vector2d step = factor_ * vector.cwiseProduct(per_unit_);
    const double length = step.cwiseQuotient(size_).norm();
    constexpr double seen = 1e-3, map_on_page = 0.5, largest_head = 0.6;
    if (length < seen) return "";
    return fmt::format("set arrow from {},{} rto {},{} front {} size screen {:.4f},{}\n", from.x(), from.y(),
                       step.x(), step.y(), line, std::min(head, largest_head * map_on_page * length), form);
  }

  const std::vector<ArrowPair>& pairs_;
  Eigen::Vector2d per_unit_, size_, longest_ = Eigen::Vector2d::Zero();
  double factor_ = 0;
};

/// Does the region have the point, its border counted in?
bool has_point(const ParameterPolygon& polygon, const Eigen::Vector2d& p) {
  const std::size_t count = polygon.corners.size();
  double least = 0, most = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector2d a = corner_at(polygon, k) - p, b = corner_at(polygon, (k + 1) % count) - p;
    const double turn = a.x() * b.y() - a.y() * b.x();
    least = std::min(least, turn);
    most = std::max(most, turn);
  }
  return least >= 0 || most <= 0;
}

}  // namespace

Drawing atlas_drawing(const SolvedAtlas& solved, const Scene& scene) {
  const AtlasMap& map = *solved.map;
  std::string data, plots;
  const auto plot = [&](const std::string& text) { plots += (plots.empty() ? "plot " : ", \\\n  ") + text; };
  const auto bound = [](const convex::Fraction& x) { return convex::nearest_double(x); };
  const bool shows_file = sign(map.over[0].low) <= 0 && sign(map.over[0].high) >= 0 &&
                          sign(map.over[1].low) <= 0 && sign(map.over[1].high) >= 0;
  bool hatched = false, file_has_region = false, others_in_key = false;
  std::vector<ArrowPair> pairs;
  std::vector<std::string> key{"the force of the file", "free acceleration A⁻¹z", "true acceleration"};
  const std::vector<std::string> titles = region_names(solved, map.regions);
  const std::vector<std::size_t> fills = region_fills(map.regions);
  const auto shared = static_cast<std::size_t>(std::count(fills.begin(), fills.end(), most_fills - 1));
  for (std::size_t k = 0; k < map.regions.size(); ++k) {
    const PlaneRegion& region = map.regions[k];
    const std::string name = fmt::format("region{}", k), right = fmt::format("right{}", k);
    data += block(name, region.polygon);
    const bool is_one_of_others = shared > 1 && fills[k] == most_fills - 1;
    if (!is_one_of_others || !others_in_key)
      key.push_back(is_one_of_others ? fmt::format("{} smaller regions", shared) : titles[k]);
    plot(fmt::format("${} with filledcurves closed {} {}", name,
                     set_fill(fills[k], "border lc rgb \"#888888\""),
                     is_one_of_others && others_in_key ? "notitle" : "title " + quoted(key.back())));
    others_in_key = others_in_key || is_one_of_others;
    if (region.right && region.right->area < region.polygon.area) {
      hatched = true;
      plot(fmt::format(
          "${} with filledcurves closed fs transparent pattern 4 noborder fc rgb \"#777777\" notitle", name));
      if (sign(region.right->area) > 0) {
        data += block(right, *region.right);
        plot(fmt::format("${} with filledcurves closed {} notitle", right, set_fill(fills[k], "noborder")));
      }
    }
    plot(fmt::format("${} with lines lc rgb \"#555555\" lw 0.8 notitle", name));
    // The force of the file has the arrows of its region.
    if (shows_file && !file_has_region && has_point(region.polygon, {0, 0}))
      file_has_region = true;
    else if (convex::nearest_double(region.polygon.area) >= least_part * map.area())
      pairs.push_back(arrows_at(map, scene, centre(region.polygon)));
  }
  if (shows_file) {
    pairs.push_back(arrows_at(map, scene, {0, 0}));
    plot(
        "\"+\" using (0):(0) every ::0::0 with points pt 7 ps 0.7 lc rgb \"#000000\" title \"the force of "
        "the file\"");
  }
  const Eigen::Vector2d low(bound(map.over[0].low), bound(map.over[1].low)),
      high(bound(map.over[0].high), bound(map.over[1].high));
  const auto coordinate = [&](std::size_t k) { return solved.coordinates[map.over[k].coordinate]; };
  plot("NaN with lines lc rgb \"#d55e00\" lw 4.6 title \"free acceleration A⁻¹z\"");
  plot("NaN with lines lc rgb \"#0072b2\" lw 1.6 title \"true acceleration\"");
  if (hatched) {
    key.emplace_back("dropping negatives is wrong");
    plot(fmt::format("NaN with boxes fs pattern 4 border lc rgb \"#777777\" fc rgb \"#777777\" title \"{}\"",
                     key.back()));
  }
  const double frame = std::max(map_frame, key_height(key.size()));
  const auto scale = [&](std::size_t k) {
    return std::sqrt(scene.problem.A.diagonal()[static_cast<convex::Index>(map.over[k].coordinate)]);
  };
  const ArrowsOnMap arrows(pairs, {scale(0), scale(1)}, {map_right - map_left, frame}, low, high);
  Drawing made;
  made.height = static_cast<int>(map_above + frame + map_below);
  made.width = width_with_key(map_key, key);
  // Centred on the map, it must not leave the page on the left.
  const double room = map_left + map_right - 12;
  std::string heading = heading_line(solved.title.empty() ? solved.file : solved.title, room);
  if (!pairs.empty())
    heading += "\n" + heading_line(fmt::format("arrows: accelerations, to one scale of the kinetic metric; "
                                               "largest |{}''| = {}, |{}''| = {}",
                                               coordinate(0), number_text(arrows.longest().x()),
                                               coordinate(1), number_text(arrows.longest().y())),
                                   room);
  made.script =
      data + arrows.script() +
      fmt::format(
          "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\n"
          "set bmargin at screen {}\nset xrange [{}:{}]\nset yrange [{}:{}]\nset title {} font \",11\" "
          "offset "
          "0,-0.4\n"
          "set xlabel {} font \",10\"\nset ylabel {} font \",10\"\nset border 15 lc rgb \"#666666\" lw 0.7\n"
          "set tics nomirror out font \",9\"\nset key at screen {}, graph 1 left top Left reverse font "
          "\",9\" "
          "samplen 1.5\n",
          map_left / made.width, map_right / made.width, 1 - map_above / made.height, map_below / made.height,
          low.x(), high.x(), low.y(), high.y(), quoted(heading), quoted(map.over[0].key + ", added"),
          quoted(map.over[1].key + ", added"), map_key / made.width) +
      plots + "\n";
  return made;
}

}  // namespace cli::inline drawings
