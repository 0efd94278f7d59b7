#include "cli/drawing/sweep_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/drawing/label_placement.hpp"

namespace cli::inline drawings {
namespace {

/// Sets of contacts: pale, apart in grey too (Okabe and Ito 2008, lightened).
constexpr std::array band_colours{"#ffffff", "#fbd9a5", "#bfe0f5", "#a9dcc8", "#f7f2ae",
                                  "#a9c7dd", "#eec1a3", "#e6c6d8", "#c8c8c8", "#8fb8a8"};
constexpr std::array curve_colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#000000", "#56b4e9", "#e69f00", "#7f7f7f"};
constexpr std::size_t most_points = 20000, most_drawn = 8;

/// Pixels, of the diagrams; the key is beside them.
constexpr double sweep_left = 84, sweep_right = 500, sweep_key = 512;

/// And above the diagrams.
double above(const std::string& title) { return title.empty() ? 12 : 30; }

/// The sets that occur, in the order of their first point.
class ContactSets {
 public:
  ContactSets(const std::vector<SweepPoint>& points, const std::vector<std::string>& constraints)
      : constraints_(constraints) {
    for (const SweepPoint& point : points) of(point);
  }
  std::size_t of(const SweepPoint& point) {
    const std::string name = name_of(point);
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) return static_cast<std::size_t>(found - names_.begin());
    names_.push_back(name);
    return names_.size() - 1;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::string name_of(const SweepPoint& point) const {
    if (!point.has_answer()) return point.status;
    if (point.active.empty()) return "no contact";
    std::string name;
    constexpr std::size_t longest = 40;
    for (const convex::Index a : point.active) {
      if (name.size() > longest) return name + ", …";
      name += (name.empty() ? "" : ", ") + constraints_[static_cast<std::size_t>(a)];
    }
    return name;
  }
  const std::vector<std::string>& constraints_;
  std::vector<std::string> names_;
};

const char* band_colour(std::size_t set) { return band_colours[set % band_colours.size()]; }

/// Entries of the key for the sets, drawn with no points.
std::string sets_in_key(const ContactSets& sets) {
  std::string text;
  for (std::size_t k = 0; k < sets.names().size(); ++k)
    text += fmt::format(", \\\n  NaN with boxes fs solid 1 border lc rgb \"#888888\" fc rgb \"{}\" title {}",
                        band_colour(k), quoted(sets.names()[k]));
  return text;
}

struct CurvePanel {
  std::string label;
  std::vector<std::size_t> columns;  // of what is watched
};

std::vector<CurvePanel> panels_of(const std::vector<Watched>& watched, bool is_unique) {
  const char* multipliers = is_unique ? "lambda" : "lambda: least norm; not unique";
  std::vector<CurvePanel> panels{{"q''", {}}, {multipliers, {}}, {"reaction", {}}, {"G", {}}};
  for (std::size_t k = 0; k < watched.size(); ++k) {
    auto& columns = panels[static_cast<std::size_t>(watched[k].of)].columns;
    if (columns.size() < most_drawn) columns.push_back(k);
  }
  std::erase_if(panels, [](const CurvePanel& panel) { return panel.columns.empty(); });
  return panels;
}

std::string number_text(double x) { return std::isfinite(x) ? fmt::format("{}", x) : std::string("NaN"); }

Drawing bands(const std::vector<SweepPoint>& points, const SweepRange& range,
              const std::vector<Watched>& watched, ContactSets& sets, const std::string& title) {
  std::vector<const SweepPoint*> sorted;
  for (const SweepPoint& point : points) sorted.push_back(&point);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const SweepPoint* a, const SweepPoint* b) { return a->at[0] < b->at[0]; });
  const double first = sorted.front()->at[0], last = sorted.back()->at[0];
  std::string objects, data;
  double from = first;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    data += fmt::format("{}", sorted[k]->at[0]);
    for (const double value : sorted[k]->watched) data += " " + number_text(value);
    data += "\n";
    // A set holds from one change to the next; a change belongs to neither side.
    const std::size_t set = sets.of(*sorted[k]);
    const bool ends = k + 1 == sorted.size() || sorted[k + 1]->is_change ||
                      (!sorted[k]->is_change && sets.of(*sorted[k + 1]) != set);
    if (!ends || sorted[k]->is_change) continue;
    const double to = k + 1 == sorted.size()     ? last
                      : sorted[k + 1]->is_change ? sorted[k + 1]->at[0]
                                                 : (sorted[k]->at[0] + sorted[k + 1]->at[0]) / 2;
    if (set > 0 || band_colour(set) != band_colours[0])
      objects += fmt::format(
          "set object rectangle from {}, graph 0 to {}, graph 1 behind fc rgb \"{}\" fs solid 1 noborder\n",
          from, to, band_colour(set));
    from = to;
  }
  const std::vector<CurvePanel> panels =
      panels_of(watched, std::all_of(points.begin(), points.end(),
                                     [](const SweepPoint& point) { return point.has_unique_multipliers; }));
  Drawing made;
  constexpr int panel_height = 210;
  made.height = panel_height * static_cast<int>(panels.size()) + 50;
  made.script = "$points << EOD\n" + data + "EOD\n" + objects;
  std::vector<std::string> words = sets.names();
  for (const CurvePanel& panel : panels)
    for (const std::size_t column : panel.columns) words.push_back(watched[column].name);
  made.width = width_with_key(sweep_right, words);
  made.script += fmt::format(
      "set multiplot layout {},1 title {} font \",11\" margins {},{},{},{} spacing 0.04\nset xrange [{}:{}]\n"
      "set border 3 lc rgb \"#666666\" lw 0.7\nset tics nomirror font \",9\"\n"
      "set key at screen {}, graph 1 left top Left reverse font \",9\" samplen 1.5\n",
      panels.size(), quoted(title), sweep_left / made.width, sweep_right / made.width, 50.0 / made.height,
      1 - above(title) / made.height, first, last > first ? last : first + 1, sweep_key / made.width);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const bool is_last = p + 1 == panels.size();
    made.script += fmt::format("set ylabel {} font \",10\"\n", quoted(panels[p].label));
    made.script += is_last ? fmt::format("set xlabel {} font \",10\"\nset format x\n", quoted(range.key))
                           : std::string("unset xlabel\nset format x \"\"\n");
    made.script += "plot ";
    for (std::size_t k = 0; k < panels[p].columns.size(); ++k)
      made.script +=
          fmt::format("{}$points using 1:{} with lines lc rgb \"{}\" lw 1.6 title {}",
                      k > 0 ? ", \\\n  " : "", panels[p].columns[k] + 2,
                      curve_colours[k % curve_colours.size()], quoted(watched[panels[p].columns[k]].name));
    made.script += (p == 0 ? sets_in_key(sets) : "") + "\n";
  }
  made.script += "unset multiplot\n";
  return made;
}

/// The borders of cells around sorted values, halfway between them.
std::vector<double> borders_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<double> borders;
  const double lone = 0.5 * std::max(1.0, std::abs(values.front()));
  const double before = values.size() > 1 ? (values[1] - values[0]) / 2 : lone;
  borders.push_back(values.front() - before);
  for (std::size_t k = 1; k < values.size(); ++k) borders.push_back((values[k - 1] + values[k]) / 2);
  const std::size_t n = values.size();
  borders.push_back(values.back() + (n > 1 ? (values[n - 1] - values[n - 2]) / 2 : lone));
  return borders;
}

Drawing map(const std::vector<SweepPoint>& points, const std::vector<SweepRange>& ranges, ContactSets& sets,
            const std::string& title) {
  const std::vector<double> x = borders_of(ranges[0].values), y = borders_of(ranges[1].values);
  const auto cell = [](const std::vector<double>& borders, double value) {
    const auto above = std::upper_bound(borders.begin(), borders.end(), value);
    const auto k = static_cast<std::size_t>(above - borders.begin());
    return std::pair{borders[k - 1], borders[k]};
  };
  std::vector<std::string> data(sets.names().size());
  for (const SweepPoint& point : points) {
    const auto [left, right] = cell(x, point.at[0]);
    const auto [low, high] = cell(y, point.at[1]);
    data[sets.of(point)] +=
        fmt::format("{} {} {} {} {} {}\n", point.at[0], point.at[1], left, right, low, high);
  }
  Drawing made;
  made.height = 480;
  made.width = width_with_key(sweep_right, sets.names());
  for (std::size_t k = 0; k < data.size(); ++k)
    made.script += fmt::format("$set{} << EOD\n{}EOD\n", k, data[k]);
  made.script += fmt::format(
      "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset title {} font "
      "\",11\"\n"
      "set bmargin at screen 0.12\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
      "set xlabel {} font \",10\"\nset ylabel {} font \",10\"\nset border 15 lc rgb \"#666666\" lw 0.7\n"
      "set tics nomirror out font \",9\"\nset key at screen {}, graph 1 left top Left reverse font \",9\" "
      "samplen 1.5\nplot ",
      sweep_left / made.width, sweep_right / made.width, 1 - above(title) / made.height, quoted(title),
      x.front(), x.back(), y.front(), y.back(), quoted(ranges[0].key), quoted(ranges[1].key),
      sweep_key / made.width);
  constexpr std::size_t with_borders = 2500;
  const std::string border = points.size() <= with_borders ? "border lc rgb \"#bbbbbb\"" : "noborder";
  for (std::size_t k = 0; k < data.size(); ++k)
    made.script +=
        fmt::format("{}$set{} using 1:2:3:4:5:6 with boxxyerror fs solid 1 {} fc rgb \"{}\" lw 0.4 title {}",
                    k > 0 ? ", \\\n  " : "", k, border, band_colour(k), quoted(sets.names()[k]));
  made.script += "\n";
  return made;
}

}  // namespace

void SweepRecord::add(const SweepPoint& point) {
  const bool taken = seen_ % stride_ == 0 || point.is_change;
  if (!point.is_change) ++seen_;
  if (!taken) return;
  points_.push_back(point);
  // A map needs all of its cells; it is larger than the screen long before it is too large here.
  if (points_.size() <= most_points || point.at.size() > 1) return;
  std::vector<SweepPoint> kept;
  for (std::size_t k = 0; k < points_.size(); ++k)
    if (k % 2 == 0 || points_[k].is_change) kept.push_back(std::move(points_[k]));
  points_ = std::move(kept);
  stride_ *= 2;
}

Drawing sweep_drawing(const SweepRecord& record, const std::vector<SweepRange>& ranges,
                      const std::vector<Watched>& watched, const std::vector<std::string>& constraints,
                      const std::string& title) {
  ContactSets sets(record.points(), constraints);
  return ranges.size() == 1 ? bands(record.points(), ranges[0], watched, sets, title)
                            : map(record.points(), ranges, sets, title);
}

}  // namespace cli::inline drawings
