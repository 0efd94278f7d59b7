#include "cli/drawing/sweep_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "cli/drawing/contact_sets.hpp"
#include "cli/drawing/label_placement.hpp"
#include "cli/drawing/stacked_diagrams.hpp"

namespace cli::inline drawings {
namespace {

constexpr std::size_t most_points = 20000, most_drawn = 8;

/// Pixels, of the diagrams; the key is beside them.
constexpr double sweep_left = 84, sweep_right = 500;

/// The sets that occur, in the order of their first point. Those beyond the fills of gnuplot share the last.
class ContactSets {
 public:
  ContactSets(const std::vector<SweepPoint>& points, const std::vector<std::string>& constraints) {
    std::vector<std::string> names, numbers;
    for (const SweepPoint& point : points)
      if (place_.emplace(key_of(point), names.size()).second) {
        names.push_back(name_of(point, constraints));
        numbers.push_back(fmt::format("set {}", names.size()));
      }
    names_ = told_apart(names, numbers);
    if (names_.size() <= most_fills) return;
    const std::size_t others = names_.size() - most_fills + 1;
    names_.resize(most_fills);
    names_.back() = fmt::format("{} other sets", others);
  }
  std::size_t of(const SweepPoint& point) const {
    return std::min(place_.at(key_of(point)), names_.size() - 1);
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  using Key = std::pair<std::string, std::vector<convex::Index>>;
  /// Without an answer its reason counts, and no contacts.
  static Key key_of(const SweepPoint& point) {
    return point.has_answer() ? Key{"", point.active} : Key{point.status, {}};
  }
  static std::string name_of(const SweepPoint& point, const std::vector<std::string>& constraints) {
    if (!point.has_answer()) return point.status;
    std::vector<std::string> held;
    for (const convex::Index a : point.active) held.push_back(constraints[static_cast<std::size_t>(a)]);
    return contact_set_name(held, constraints);
  }
  std::map<Key, std::size_t> place_;
  std::vector<std::string> names_;
};

/// Entries of the key for the sets, drawn with no points.
std::string sets_in_key(const ContactSets& sets) {
  std::string text;
  for (std::size_t k = 0; k < sets.names().size(); ++k)
    text += fmt::format(", \\\n  NaN with boxes {} title {}", set_fill(k, "border lc rgb \"#888888\""),
                        quoted(sets.names()[k]));
  return text;
}

struct CurvePanel {
  std::string label;
  std::vector<std::size_t> columns = {};  // of what is watched
  std::size_t left_out = 0;
};

std::vector<CurvePanel> panels_of(const std::vector<Watched>& watched, bool is_unique) {
  const char* multipliers = is_unique ? "lambda" : "lambda: least norm; not unique";
  std::vector<CurvePanel> panels{{"q''"}, {multipliers}, {"reaction"}, {"G"},      {"q"},
                                 {"q'"},  {"f"},         {"df/dt"},    {"d²f/dt²"}};
  for (std::size_t k = 0; k < watched.size(); ++k) {
    CurvePanel& panel = panels[static_cast<std::size_t>(watched[k].of)];
    if (panel.columns.size() < most_drawn)
      panel.columns.push_back(k);
    else
      ++panel.left_out;
  }
  std::erase_if(panels, [](const CurvePanel& panel) { return panel.columns.empty(); });
  return panels;
}

std::string number_text(double x) { return std::isfinite(x) ? fmt::format("{}", x) : std::string("NaN"); }

/// Half of the room of a value that is the only one.
double lone_half(double value) { return 0.5 * std::max(1.0, std::abs(value)); }

Drawing bands(const std::vector<SweepPoint>& points, const SweepRange& range,
              const std::vector<Watched>& watched, const ContactSets& sets, const std::string& title) {
  std::vector<const SweepPoint*> sorted;
  for (const SweepPoint& point : points) sorted.push_back(&point);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const SweepPoint* a, const SweepPoint* b) { return a->at[0] < b->at[0]; });
  const double first = sorted.front()->at[0], last = sorted.back()->at[0];
  const double alone = last > first ? 0 : lone_half(first);  // room around one value
  std::string objects, data;
  double from = first - alone;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    data += fmt::format("{}", sorted[k]->at[0]);
    for (const double value : sorted[k]->watched) data += " " + number_text(value);
    data += "\n";
    // A set holds from one change to the next; a change belongs to neither side.
    const std::size_t set = sets.of(*sorted[k]);
    const bool ends = k + 1 == sorted.size() || sorted[k + 1]->is_change ||
                      (!sorted[k]->is_change && sets.of(*sorted[k + 1]) != set);
    if (!ends || sorted[k]->is_change) continue;
    const double to = k + 1 == sorted.size()     ? last + alone
                      : sorted[k + 1]->is_change ? sorted[k + 1]->at[0]
                                                 : (sorted[k]->at[0] + sorted[k + 1]->at[0]) / 2;
    if (set > 0)  // white
      objects += fmt::format("set object rectangle from {}, graph 0 to {}, graph 1 behind {}\n", from, to,
                             set_fill(set, "noborder"));
    from = to;
  }
  const std::vector<CurvePanel> panels =
      panels_of(watched, std::all_of(points.begin(), points.end(),
                                     [](const SweepPoint& point) { return point.has_unique_multipliers; }));
  StackedDiagrams stacked{sweep_left, sweep_right, {}};
  for (const CurvePanel& panel : panels) {
    std::vector<std::string> names;
    for (const std::size_t column : panel.columns) names.push_back(watched[column].name);
    stacked.keys.push_back(key_of_curves(std::move(names), panel.left_out));
  }
  stacked.keys[0].insert(stacked.keys[0].end(), sets.names().begin(), sets.names().end());
  Drawing made = stacked.page(title);
  made.script = "$points << EOD\n" + data + "EOD\n" + objects + made.script +
                fmt::format("set xrange [{}:{}]\n", first - alone, last + alone);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    DrawnRange values;
    for (const SweepPoint& point : points)
      for (const std::size_t column : panels[p].columns) values.add(point.watched[column]);
    made.script +=
        axes_of_diagram(made, panels[p].label, range.key, p + 1 == panels.size(), {first, last}, values);
    made.script += "plot ";
    for (std::size_t k = 0; k < panels[p].columns.size(); ++k)
      made.script += fmt::format("{}$points using 1:{} with {} {} lw 1.6 title {}", k > 0 ? ", \\\n  " : "",
                                 panels[p].columns[k] + 2, points.size() > 1 ? "lines" : "linespoints",
                                 curve_style(k), quoted(watched[panels[p].columns[k]].name));
    made.script += left_out_in_key(panels[p].left_out) + (p == 0 ? sets_in_key(sets) : "") + "\n";
  }
  made.script += "unset multiplot\n";
  return made;
}

/// The borders of cells around sorted values, halfway between them.
std::vector<double> borders_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<double> borders;
  const double lone = lone_half(values.front());
  const double before = values.size() > 1 ? (values[1] - values[0]) / 2 : lone;
  borders.push_back(values.front() - before);
  for (std::size_t k = 1; k < values.size(); ++k) borders.push_back((values[k - 1] + values[k]) / 2);
  const std::size_t n = values.size();
  borders.push_back(values.back() + (n > 1 ? (values[n - 1] - values[n - 2]) / 2 : lone));
  return borders;
}

/// The cells of a grid of points.
class Cells {
 public:
  explicit Cells(const std::vector<SweepRange>& ranges)
      : x(borders_of(ranges[0].values)), y(borders_of(ranges[1].values)) {}
  /// By its numbers along x and y.
  std::pair<std::size_t, std::size_t> of(const SweepPoint& point) const {
    return {below(x, point.at[0]), below(y, point.at[1])};
  }
  const std::vector<double> x, y;

 private:
  static std::size_t below(const std::vector<double>& borders, double value) {
    return static_cast<std::size_t>(std::upper_bound(borders.begin(), borders.end(), value) -
                                    borders.begin()) -
           1;
  }
};

/// A page with the axes of two ranges, and what is in its key.
Drawing page_of_map(const Cells& cells, const std::vector<SweepRange>& ranges, const std::string& title,
                    const std::vector<std::string>& key) {
  constexpr double above = 34, below = 58, least_frame = 390, key_apart = 12;
  const double frame = std::max(least_frame, key_height(key.size()));
  Drawing made;
  made.height = static_cast<int>(above + frame + below);
  made.width = width_with_key(sweep_right, key);
  made.script = fmt::format(
      "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset title {} font "
      "\",11\" offset 0,-0.4\n"
      "set bmargin at screen {}\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
      "set xlabel {} font \",10\"\nset ylabel {} font \",10\"\nset border 15 lc rgb \"#666666\" lw 0.7\n"
      "set tics nomirror out font \",9\"\nset key at screen {}, graph 1 left top Left reverse font \",9\" "
      "samplen 1.5\n{}{}",
      sweep_left / made.width, sweep_right / made.width, 1 - above / made.height,
      quoted(heading_line(title, sweep_left + sweep_right - 12)), below / made.height, cells.x.front(),
      cells.x.back(), cells.y.front(), cells.y.back(), quoted(ranges[0].key), quoted(ranges[1].key),
      (sweep_right + key_apart) / made.width, tic_format("x", {cells.x.front(), cells.x.back()}),
      tic_format("y", {cells.y.front(), cells.y.back()}));
  return made;
}

Drawing map(const std::vector<SweepPoint>& points, const std::vector<SweepRange>& ranges,
            const ContactSets& sets, const std::string& title) {
  const Cells cells(ranges);
  std::vector<std::string> data(sets.names().size());
  for (const SweepPoint& point : points) {
    const auto [i, j] = cells.of(point);
    data[sets.of(point)] += fmt::format("{} {} {} {} {} {}\n", point.at[0], point.at[1], cells.x[i],
                                        cells.x[i + 1], cells.y[j], cells.y[j + 1]);
  }
  Drawing made = page_of_map(cells, ranges, title, sets.names());
  std::string blocks;
  for (std::size_t k = 0; k < data.size(); ++k) blocks += fmt::format("$set{} << EOD\n{}EOD\n", k, data[k]);
  made.script = blocks + made.script + "plot ";
  constexpr std::size_t with_borders = 2500;
  const std::string border = points.size() <= with_borders ? "border lc rgb \"#bbbbbb\"" : "noborder";
  for (std::size_t k = 0; k < data.size(); ++k)
    made.script += fmt::format("{}$set{} using 1:2:3:4:5:6 with boxxyerror {} lw 0.4 title {}",
                               k > 0 ? ", \\\n  " : "", k, set_fill(k, border), quoted(sets.names()[k]));
  made.script += "\n";
  return made;
}

/// The colours of one number, lines where the contacts change, white where there is no answer.
Drawing map_of_number(const std::vector<SweepPoint>& points, const std::vector<SweepRange>& ranges,
                      const ContactSets& sets, const Watched& watched, const std::string& title) {
  const Cells cells(ranges);
  const std::size_t columns = cells.x.size() - 1, rows = cells.y.size() - 1, none = sets.names().size();
  std::vector<std::size_t> set_of(columns * rows, none);
  std::string values, lines;
  for (const SweepPoint& point : points) {
    const auto [i, j] = cells.of(point);
    set_of[i * rows + j] = sets.of(point);
    if (!std::isfinite(point.watched[0])) continue;
    values += fmt::format("{} {} {} {} {} {} {}\n", point.at[0], point.at[1], cells.x[i], cells.x[i + 1],
                          cells.y[j], cells.y[j + 1], point.watched[0]);
  }
  for (std::size_t i = 0; i < columns; ++i)
    for (std::size_t j = 0; j < rows; ++j) {
      if (i + 1 < columns && set_of[i * rows + j] != set_of[(i + 1) * rows + j])
        lines += fmt::format("{0} {1}\n{0} {2}\n\n", cells.x[i + 1], cells.y[j], cells.y[j + 1]);
      if (j + 1 < rows && set_of[i * rows + j] != set_of[i * rows + j + 1])
        lines += fmt::format("{0} {2}\n{1} {2}\n\n", cells.x[i], cells.x[i + 1], cells.y[j + 1]);
    }
  Drawing made = page_of_map(cells, ranges, title + ": " + watched.name + "; lines: the contacts change",
                             {std::string(8, ' ')});
  made.script = "$values << EOD\n" + (values.empty() ? "NaN NaN NaN NaN NaN NaN NaN\n" : values) +
                "EOD\n$changes << EOD\n" + (lines.empty() ? "NaN NaN\n" : lines) + "EOD\n" + made.script +
                "unset key\nset palette defined (0 '#f7fbff', 0.5 '#6baed6', 1 '#08306b')\n" +
                "set colorbox user origin graph 1.04,0 size graph 0.035,1\n" +
                "plot $values using 1:2:3:4:5:6:7 with boxxyerror fc palette fs solid noborder, \\\n" +
                "  $changes with lines lc rgb \"#222222\" lw 1.2\n";
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
                      const std::string& title, bool is_chosen) {
  const ContactSets sets(record.points(), constraints);
  if (ranges.size() == 1) return bands(record.points(), ranges[0], watched, sets, title);
  return is_chosen && watched.size() == 1
             ? map_of_number(record.points(), ranges, sets, watched.front(), title)
             : map(record.points(), ranges, sets, title);
}

}  // namespace cli::inline drawings
