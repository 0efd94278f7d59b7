#include "cli/drawing/motion_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "cli/drawing/stacked_diagrams.hpp"
#include "cli/motion_files.hpp"
#include "mechanics/motion/taylor_series.hpp"

namespace cli::inline drawings {
namespace {

using convex::Index;
using convex::Vector;

constexpr Index most_curves = 8;
constexpr long points = 1201;
/// Events are told apart no closer than so many to the picture's length.
constexpr long mark_places = 500;

/// Events are told apart by their dashes, not by the colours of the curves.
std::string style(mechanics::EventKind kind) {
  const char* dashes = "5";
  switch (kind) {
    case mechanics::EventKind::impact:
      dashes = "1";
      break;
    case mechanics::EventKind::contact:
      dashes = "2";
      break;
    case mechanics::EventKind::release:
      dashes = "3";
      break;
    case mechanics::EventKind::accumulation:
      dashes = "4";
      break;
    case mechanics::EventKind::branch:
      break;
  }
  // Impacts may be many; what is dashed must still be seen.
  const bool is_full = kind == mechanics::EventKind::impact;
  return fmt::format("lc rgb \"{}\" lw {} dt {}", is_full ? "#888888" : "#222222", is_full ? 0.5 : 1.2,
                     dashes);
}

/// Of more events the lines would be the picture: they are marks above the diagrams.
constexpr std::size_t most_event_lines = 12;

/// gnuplot's mark of an event above a diagram, where there are many.
std::string mark(mechanics::EventKind kind) {
  switch (kind) {
    case mechanics::EventKind::impact:
      return "pt \"|\" lc rgb \"#555555\" font \",7\"";
    case mechanics::EventKind::contact:
      return "pt 11 ps 0.5 lc rgb \"#222222\"";
    case mechanics::EventKind::release:
      return "pt 8 ps 0.5 lc rgb \"#222222\"";
    case mechanics::EventKind::accumulation:
      return "pt 7 ps 0.45 lc rgb \"#222222\"";
    case mechanics::EventKind::branch:
      return "pt 5 ps 0.45 lc rgb \"#222222\"";
  }
  return "";
}

/// Pixels; the key is beside them.
constexpr double motion_left = 77, motion_right = 574;

/// One panel: curves of some columns of the points.
struct Panel {
  std::string label;
  std::vector<std::string> names;
  Index first_column;
  std::size_t left_out;  ///< as many are not drawn
};

/// Lengths and angles may stand on one axis, whose units the file alone knows.
std::string axis_name(const Panel& panel) {
  if (panel.label != "q") return panel.label;
  constexpr std::size_t longest = 14;
  std::string names;
  for (const std::string& name : panel.names) names += (names.empty() ? "" : ", ") + name;
  return (names.size() <= longest ? names : "q") + ", in units of the file";
}

/// What begins at 0 is drawn at 0 where rounding is below it.
std::string panel_curves(const Panel& panel, bool from_zero, const std::string& key_of_events) {
  std::string text = "plot ";
  for (std::size_t k = 0; k < panel.names.size(); ++k) {
    const Index column = panel.first_column + static_cast<Index>(k);
    text += fmt::format("{}$points using 1:{} with lines {} lw 1.4 title {}", k > 0 ? ", \\\n  " : "",
                        from_zero ? fmt::format("(${0}<0?0:${0})", column) : std::to_string(column),
                        curve_style(k), quoted(panel.names[k]));
  }
  return text + left_out_in_key(panel.left_out) + key_of_events + "\n";
}

}  // namespace

MotionDrawing::MotionDrawing(const mechanics::LagrangianSystem& system, double begin, double end)
    : system_(system),
      begin_(begin),
      end_(end),
      coordinates_(std::min(most_curves, static_cast<Index>(system.coordinates().size()))),
      constraints_(std::min(most_curves, static_cast<Index>(system.constraints().size()))) {}

double MotionDrawing::time(double point) const {
  return begin_ + (end_ - begin_) * point / static_cast<double>(points - 1);
}

Vector MotionDrawing::row(const mechanics::State& state, const Vector& lambda) {
  const mechanics::ConstraintRates rates = system_.constraint_rates(state);
  for (Index a = 0; a < constraints_; ++a) gaps_.count_beside(rates.f_scale[a]);
  return row(state, rates.f, lambda);
}

Vector MotionDrawing::row(const mechanics::Arc& arc, double tau) {
  if (arc.f.rows() == 0) return row(arc.state(tau), arc.multipliers(tau));
  Vector f(constraints_);
  for (Index a = 0; a < constraints_; ++a) f[a] = mechanics::value_at(mechanics::coefficients(arc.f, a), tau);
  return row(arc.state(tau), f, arc.multipliers(tau));
}

Vector MotionDrawing::row(const mechanics::State& state, const Vector& f, const Vector& lambda) {
  mechanics::State at_rest = state;
  at_rest.v.setZero();
  const double energy = system_.energy(state), potential = system_.energy(at_rest);
  energies_.count_beside(std::max(std::abs(potential), std::abs(energy - potential)));
  Vector drawn(coordinates_ + 2 * constraints_ + 1);
  drawn << state.q.head(coordinates_), f.head(constraints_), lambda.head(constraints_), energy;
  return drawn;
}

void MotionDrawing::add(double t, const Vector& row) {
  if (passed_ > 0) {
    passed_ = 0;
    for (const Vector& extreme : {least_, most_}) add(time(static_cast<double>(point_) - 0.5), extreme);
  }
  points_ += fmt::format("{} {}\n", t, fmt::join(row, " "));
  for (Index k = 0; k < row.size(); ++k) {
    const Index of_constraint = k - coordinates_;
    (of_constraint < 0                  ? positions_
     : of_constraint < constraints_     ? gaps_
     : of_constraint < 2 * constraints_ ? forces_
                                        : energies_)
        .add(row[k]);
  }
}

void MotionDrawing::pass(const Vector& row) {
  least_ = passed_ > 0 ? Vector(least_.cwiseMin(row)) : row;
  most_ = passed_ > 0 ? Vector(most_.cwiseMax(row)) : row;
  ++passed_;
}

void MotionDrawing::follow(const mechanics::Motion& motion) {
  const mechanics::Arc& arc = motion.arc();
  const long first = point_;
  for (; point_ < points; ++point_) {
    const double t = time(static_cast<double>(point_));
    if (!(t < motion.state().t)) break;
    add(t, row(arc, std::clamp(t - arc.t, 0.0, arc.length)));
  }
  // What is shorter than the points are apart is seen in its middle and at its ends.
  const bool is_between = point_ == first && arc.length > 0;
  constexpr long most_passed = 16;  // of a crowd of impacts the first are enough
  const bool is_more_of_a_crowd =
      passed_ >= most_passed &&
      std::all_of(motion.events().begin(), motion.events().end(),
                  [](const auto& event) { return event.kind == mechanics::EventKind::impact; });
  if (is_between && !is_more_of_a_crowd) pass(row(arc, arc.length / 2));
  if (!motion.events().empty() && point_ > 0 && !is_more_of_a_crowd) {
    pass(row(arc, arc.length));
    if (motion.multipliers().size() == static_cast<Index>(system_.constraints().size()))
      pass(row(motion.state(), motion.multipliers()));
  }
  for (const mechanics::MotionEvent& event : motion.events())
    events_.emplace(event.kind,
                    std::lround((event.t - begin_) / (end_ - begin_) * static_cast<double>(mark_places)));
}

void MotionDrawing::finish(const mechanics::Motion& motion) {
  if (motion.multipliers().size() != static_cast<Index>(system_.constraints().size())) return;
  add(motion.state().t, row(motion.state(), motion.multipliers()));
}

Drawing MotionDrawing::drawing(const std::string& title) const {
  const std::vector<std::string> constraints = constraint_names(system_);
  const auto left_out = [](std::size_t all, Index drawn) { return all - static_cast<std::size_t>(drawn); };
  const std::vector<std::string>& coordinates = system_.coordinates();
  std::vector<Panel> panels{{"q",
                             {coordinates.begin(), coordinates.begin() + coordinates_},
                             2,
                             left_out(coordinates.size(), coordinates_)}};
  if (constraints_ > 0) {
    const std::vector<std::string> drawn(constraints.begin(), constraints.begin() + constraints_);
    const std::size_t more = left_out(constraints.size(), constraints_);
    panels.push_back({"f", drawn, 2 + coordinates_, more});
    panels.push_back({"lambda", drawn, 2 + coordinates_ + constraints_, more});
  }
  panels.push_back({"energy", {"T + V"}, 2 + coordinates_ + 2 * constraints_, 0});
  std::map<mechanics::EventKind, std::string> kinds;
  std::string marks;
  const bool are_lines = events_.size() <= most_event_lines;
  int labels = 1;  // the first names an axis
  for (const auto& [kind, place] : events_) {
    const double t = begin_ + (end_ - begin_) * static_cast<double>(place) / static_cast<double>(mark_places);
    if (are_lines || kind == mechanics::EventKind::impact)
      marks += fmt::format("set arrow from {0}, graph {1} to {0}, graph {2} nohead {3} back\n", t,
                           are_lines ? 0 : 1.02, are_lines ? 1 : 1.08,
                           are_lines ? style(kind) : "lc rgb \"#555555\" lw 0.6");
    else
      marks += fmt::format("set label {} at {}, graph 1.05 \"\" point {}\n", ++labels, t, mark(kind));
    kinds[kind] =
        fmt::format(", \\\n  NaN with {} title {}",
                    are_lines ? "lines " + style(kind) : "points " + mark(kind), quoted(name(kind)));
  }
  StackedDiagrams stacked{motion_left, motion_right, {}};
  for (const Panel& panel : panels) {
    std::vector<std::string> key = key_of_curves(panel.names, panel.left_out);
    for (const auto& [kind, line] : kinds)
      if (stacked.keys.empty()) key.emplace_back(name(kind));
    stacked.keys.push_back(key);
  }
  Drawing made = stacked.page(title);
  made.script = "$points << EOD\n" + points_ + "EOD\n" + made.script +
                fmt::format("set xrange [{}:{}]\nset grid lc rgb \"#dddddd\" lw 0.5 dt 1\n", begin_, end_) +
                marks;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const std::string& label = panels[k].label;
    const DrawnRange& range = label == "q"        ? positions_
                              : label == "f"      ? gaps_
                              : label == "lambda" ? forces_
                                                  : energies_;
    const bool from_zero = (label == "f" || label == "lambda") && range.begins_at_zero();
    std::string key;  // of events, once, below the names of coordinates
    for (const auto& [kind, line] : kinds) key += k == 0 ? line : "";
    made.script +=
        axes_of_diagram(made, axis_name(panels[k]), "t", k + 1 == panels.size(), {begin_, end_}, range) +
        (from_zero && !range.is_constant() ? "set yrange [0:*]\n" : "") +
        panel_curves(panels[k], from_zero, key);
  }
  made.script += "unset multiplot\n";
  return made;
}

}  // namespace cli::inline drawings
