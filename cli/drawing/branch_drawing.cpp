#include "cli/drawing/branch_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "cli/drawing/stacked_diagrams.hpp"

namespace cli::inline drawings {
namespace {

constexpr std::size_t most_curves_of_branch = 6;
/// Pixels; the keys are beside.
constexpr double branch_left = 91, branch_right = 546;

/// 0 where it is no more than its error; NaN of none.
double largest_multiplier(const mechanics::Orbit& orbit) {
  if (!orbit.multipliers || orbit.multipliers->empty()) return NAN;
  const double largest = std::abs(orbit.multipliers->front());
  return largest > orbit.circle_width ? largest : 0;
}

/// Columns: value, q, v, largest multiplier; what is left out interrupts its curve.
std::string columns(const BranchPoint& point, bool has_velocity = true, bool has_multiplier = true) {
  std::string text = fmt::format("{}", point.value);
  for (const double q : point.orbit.start.q) text += fmt::format(" {}", q);
  for (const double v : point.orbit.start.v) text += has_velocity ? fmt::format(" {}", v) : " NaN";
  const double largest = has_multiplier ? largest_multiplier(point.orbit) : NAN;
  return text + (std::isnan(largest) ? " NaN\n" : fmt::format(" {}\n", largest));
}

/// Between a graze and orbits with the impact that begins there: their multipliers grow beyond all bounds
/// towards it, those of the graze are of the orbits without it.
bool gains_or_loses_impacts(const BranchPoint& a, const BranchPoint& b) {
  return a.orbit.impacts.size() != b.orbit.impacts.size();
}

/// Is the piece between two orbits stable? At an event a multiplier is on the unit circle but for rounding,
/// or the orbit is one without the impacts of the piece: the one without an event tells. Between two events
/// a graze tells of its own side; on the other, with the impact, multipliers beyond all bounds do.
bool is_stable_between(const BranchPoint& a, const BranchPoint& b) {
  if (b.event.empty()) return b.orbit.is_stable;
  if (a.event.empty()) return a.orbit.is_stable;
  if (gains_or_loses_impacts(a, b)) return false;
  return (b.event == "grazing" ? b : a).orbit.is_stable;
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

/// The pieces of one stability; an orbit alone is one.
std::string pieces(const std::vector<BranchPoint>& points, bool stable) {
  if (points.size() == 1) return points[0].orbit.is_stable == stable ? columns(points[0]) : "";
  std::string text;
  bool is_inside = false;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const BranchPoint &from = points[k], &to = points[k + 1];
    const bool belongs = is_stable_between(from, to) == stable;
    if (belongs && !is_inside) text += (text.empty() ? "" : "\n") + columns(from);
    const bool velocity_jumps = passes_an_impact(from.orbit, to.orbit),
               multiplier_jumps = gains_or_loses_impacts(from, to);
    if (belongs && (velocity_jumps || multiplier_jumps))
      text += columns(from, !velocity_jumps, !multiplier_jumps);
    if (belongs) text += columns(to);
    is_inside = belongs;
  }
  return text;
}

/// The axis of the multiplier: logarithmic, on which 0 has no place, or linear around 0 and 1 where there is
/// nothing else.
class MultiplierScale {
 public:
  explicit MultiplierScale(const std::vector<BranchPoint>& points) {
    for (const BranchPoint& point : points) {
      const double largest = largest_multiplier(point.orbit);
      has_zeros_ = has_zeros_ || largest == 0;
      is_logarithmic_ = is_logarithmic_ || largest > 0;
    }
  }
  std::string label() const {
    if (!has_zeros_) return "|multiplier|";
    return is_logarithmic_ ? "|multiplier|; gaps: 0" : "|multiplier|, all 0";
  }
  std::string axis() const { return is_logarithmic_ ? "set logscale y\n" : "set yrange [-0.1:1.1]\n"; }

 private:
  bool has_zeros_ = false, is_logarithmic_ = false;
};

struct BranchPanel {
  std::string label;
  std::vector<std::string> names;
  std::size_t first_column, left_out = 0;
};

/// The words of the key, in the order of the curves.
std::vector<std::string> key_of(const BranchPanel& panel, bool has_stable, bool has_unstable,
                                const std::map<std::string, int>& events) {
  std::vector<std::string> words;
  for (std::size_t k = 0; k < panel.names.size(); ++k) {
    if (has_stable) words.push_back(panel.names[k]);
    if (has_unstable) words.push_back(panel.names[k] + ", unstable");
    for (const auto& [event, marker] : events)
      if (k == 0) words.push_back(event);
  }
  return key_of_curves(std::move(words), panel.left_out);
}

/// The curves of one panel: full where stable, dotted where not, of several told apart by open marks too,
/// and a mark at each event.
std::string panel_curves(const BranchPanel& panel, bool has_stable, bool has_unstable,
                         const std::map<std::string, int>& events, std::size_t points) {
  std::string text;
  const auto add = [&](const std::string& curve) { text += (text.empty() ? "plot " : ", \\\n  ") + curve; };
  constexpr std::size_t marks_a_curve = 10;
  for (std::size_t k = 0; k < panel.names.size(); ++k) {
    const std::string column = std::to_string(panel.first_column + k),
                      marked = panel.names.size() > 1 || points == 1
                                   ? fmt::format("linespoints pt {} ps 0.7 pi {}", 4 + 2 * k,
                                                 1 + points / marks_a_curve)
                                   : "lines";
    if (has_stable)
      add(fmt::format("$stable using 1:{} with {} lc rgb \"{}\" lw 2 title {}", column, marked,
                      curve_colour(k), quoted(panel.names[k])));
    if (has_unstable)
      add(fmt::format("$unstable using 1:{} with {} lc rgb \"{}\" lw 1.6 dt (6,4) title {}", column, marked,
                      curve_colour(k), quoted(panel.names[k] + ", unstable")));
    for (const auto& [event, marker] : events)
      add(fmt::format("${} using 1:{} with points pt {} ps 0.8 lw 1.2 lc rgb \"#222222\" {}", event, column,
                      marker, k == 0 ? "title " + quoted(event) : "notitle"));
  }
  return text + left_out_in_key(panel.left_out) + "\n";
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
  const MultiplierScale scale(points);
  const std::size_t n = coordinates.size(), drawn = std::min(n, most_curves_of_branch);
  BranchPanel q{"q", {}, 2, n - drawn}, v{"q'", {}, 2 + n, n - drawn},
      multiplier{scale.label(), {"largest"}, 2 + 2 * n};
  for (std::size_t i = 0; i < drawn; ++i) {
    q.names.push_back(coordinates[i]);
    v.names.push_back(coordinates[i] + "'");
  }
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    if (passes_an_impact(points[k].orbit, points[k + 1].orbit)) v.label = "q'; gaps: an impact passes t";
  const std::array panels{q, v, multiplier};
  std::array<DrawnRange, panels.size()> ranges;  // that of the multiplier, on its scale, is not asked for
  for (const BranchPoint& point : points)
    for (std::size_t i = 0; i < drawn; ++i) {
      ranges[0].add(point.orbit.start.q[static_cast<convex::Index>(i)]);
      ranges[1].add(point.orbit.start.v[static_cast<convex::Index>(i)]);
      if (point.orbit.largest.size() == static_cast<convex::Index>(2 * n)) {
        ranges[0].count_beside(point.orbit.largest[static_cast<convex::Index>(i)]);
        ranges[1].count_beside(point.orbit.largest[static_cast<convex::Index>(n + i)]);
      }
    }
  StackedDiagrams stacked{branch_left, branch_right, {}};
  for (const BranchPanel& panel : panels)
    stacked.keys.push_back(key_of(panel, !stable.empty(), !unstable.empty(), events));
  const Drawing page = stacked.page(title);
  made.width = page.width;
  made.height = page.height;
  made.script += page.script + "set grid lc rgb \"#dddddd\" lw 0.5 dt 1\n";
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  const double room = 0.02 * (high->value - low->value);
  if (room > 0) made.script += fmt::format("set xrange [{}:{}]\n", low->value - room, high->value + room);
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const bool is_last = k + 1 == panels.size();
    made.script +=
        axes_of_diagram(page, panels[k].label, parameter, is_last, {low->value, high->value}, ranges[k]);
    if (is_last)
      made.script += scale.axis() +
                     "set arrow from graph 0, first 1 to graph 1, first 1 nohead lc rgb \"#888888\" lw "
                     "0.8 back\n";
    made.script += panel_curves(panels[k], !stable.empty(), !unstable.empty(), events, points.size());
  }
  made.script += "unset multiplot\n";
  return made;
}

}  // namespace cli::inline drawings
