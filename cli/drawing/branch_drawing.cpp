#include "cli/drawing/branch_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace cli::inline drawings {
namespace {

constexpr std::array curve_colours{"#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#222222"};
constexpr int branch_panel_height = 230;

std::string largest_multiplier(const mechanics::Orbit& orbit) {
  if (!orbit.multipliers || orbit.multipliers->empty()) return "NaN";
  return fmt::format("{}", std::abs(orbit.multipliers->front()));
}

/// Columns: value, q, v, largest multiplier; the velocity may be left out, which interrupts its curve.
std::string columns(const BranchPoint& point, bool has_velocity = true) {
  std::string text = fmt::format("{}", point.value);
  for (const double q : point.orbit.start.q) text += fmt::format(" {}", q);
  for (const double v : point.orbit.start.v) text += has_velocity ? fmt::format(" {}", v) : " NaN";
  return text + " " + largest_multiplier(point.orbit) + "\n";
}

/// Does an impact pass the instant of the start between two orbits, so that their velocities there lie on
/// both sides of it? Impacts that keep their places in the period move less than those that are counted one
/// on, with one that left at its one end and came in at the other.
bool passes_an_impact(const mechanics::Orbit& a, const mechanics::Orbit& b) {
  const std::size_t count = a.impacts.size();
  if (count == 0 || b.impacts.size() != count) return false;
  const auto phase = [count](const mechanics::Orbit& orbit, std::size_t k) {
    const double begins = orbit.start.t + static_cast<double>(k / count) * -orbit.period;
    return (orbit.impacts[k % count].t - begins) / orbit.period;
  };
  const auto moved = [&](const mechanics::Orbit& first, const mechanics::Orbit& second, std::size_t shift) {
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) sum += std::abs(phase(first, k + shift) - phase(second, k));
    return sum;
  };
  const double kept = moved(a, b, 0);
  return moved(a, b, 1) < kept || moved(b, a, 1) < kept;
}

/// The pieces of one stability. At an event a multiplier is on the unit circle but for rounding: between two
/// orbits the one without an event tells.
std::string pieces(const std::vector<BranchPoint>& points, bool stable) {
  std::string text;
  bool is_inside = false;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const BranchPoint& tells = points[k + 1].event.empty() ? points[k + 1] : points[k];
    const bool belongs = tells.orbit.is_stable == stable;
    if (belongs && !is_inside) text += (text.empty() ? "" : "\n") + columns(points[k]);
    if (belongs && passes_an_impact(points[k].orbit, points[k + 1].orbit)) text += columns(points[k], false);
    if (belongs) text += columns(points[k + 1]);
    is_inside = belongs;
  }
  return text;
}

struct BranchPanel {
  std::string label;
  std::vector<std::string> names;
  std::size_t first_column;
};

/// The curves of one panel: full where stable, dotted where not, and a mark at each event.
std::string panel_curves(const BranchPanel& panel, bool has_stable, bool has_unstable,
                         const std::map<std::string, int>& events) {
  std::string text;
  const auto add = [&](const std::string& curve) { text += (text.empty() ? "plot " : ", \\\n  ") + curve; };
  for (std::size_t k = 0; k < panel.names.size(); ++k) {
    const char* colour = curve_colours[k % curve_colours.size()];
    const std::string name = quoted(panel.names[k]), column = std::to_string(panel.first_column + k);
    if (has_stable)
      add(fmt::format("$stable using 1:{} with lines lc rgb \"{}\" lw 2 title {}", column, colour, name));
    if (has_unstable)
      add(fmt::format("$unstable using 1:{} with lines lc rgb \"{}\" lw 1.6 dt 2 title {}", column, colour,
                      quoted(panel.names[k] + ", unstable")));
    for (const auto& [event, marker] : events)
      add(fmt::format("${} using 1:{} with points pt {} ps 1.1 lw 1.5 lc rgb \"#d55e00\" {}", event, column,
                      marker, k == 0 ? "title " + quoted(event) : "notitle"));
  }
  return text + "\n";
}

}  // namespace

Drawing branch_drawing(const std::vector<BranchPoint>& points, const std::vector<std::string>& coordinates,
                       const std::string& parameter, const std::string& title) {
  Drawing made;
  std::map<std::string, int> events;
  constexpr std::array markers{7, 5, 9, 13, 11};
  for (const BranchPoint& point : points)
    if (!point.event.empty())
      events.try_emplace(point.event, markers[std::min(events.size(), markers.size() - 1)]);
  const std::string stable = pieces(points, true), unstable = pieces(points, false);
  made.script = "$stable << EOD\n" + stable + "EOD\n$unstable << EOD\n" + unstable + "EOD\n";
  for (const auto& [event, marker] : events) {
    made.script += "$" + event + " << EOD\n";
    for (const BranchPoint& point : points)
      if (point.event == event) made.script += columns(point);
    made.script += "EOD\n";
  }
  const std::size_t n = coordinates.size(), drawn = std::min(n, curve_colours.size());
  BranchPanel q{"q", {}, 2}, v{"q'", {}, 2 + n}, multiplier{"|multiplier|", {"largest"}, 2 + 2 * n};
  for (std::size_t i = 0; i < drawn; ++i) {
    q.names.push_back(coordinates[i]);
    v.names.push_back(coordinates[i] + "'");
  }
  const std::array panels{q, v, multiplier};
  made.height = branch_panel_height * static_cast<int>(panels.size()) + 40;
  made.script += fmt::format(
      "set multiplot layout 3,1 title {} font \",11\" margins 0.13,0.78,0.07,0.94 spacing 0.03\n"
      "set grid lc rgb \"#dddddd\" lw 0.5 dt 1\nset border 3 lc rgb \"#666666\" lw 0.7\n"
      "set tics nomirror font \",9\"\nset key outside right top font \",9\" samplen 1.5\n",
      quoted(title));
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  const double room = 0.02 * (high->value - low->value);
  if (room > 0) made.script += fmt::format("set xrange [{}:{}]\n", low->value - room, high->value + room);
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const bool is_last = k + 1 == panels.size();
    made.script += fmt::format("set ylabel {} font \",10\"\n", quoted(panels[k].label));
    made.script += is_last ? fmt::format(
                                 "set xlabel {} font \",10\"\nset format x\nset logscale y\n"
                                 "set arrow from graph 0, first 1 to graph 1, first 1 nohead lc rgb "
                                 "\"#888888\" lw 0.8 back\n",
                                 quoted(parameter))
                           : "unset xlabel\nset format x \"\"\n";
    made.script += panel_curves(panels[k], !stable.empty(), !unstable.empty(), events);
  }
  made.script += "unset multiplot\n";
  return made;
}

}  // namespace cli::inline drawings
