#include "cli/drawing/phase_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/drawing/label_placement.hpp"

namespace cli::inline drawings {

PhaseDrawing::PhaseDrawing(const mechanics::LagrangianSystem& system, convex::Index coordinate,
                           Instants instants, bool is_strobe, convex::Vector modulo)
    : system_(system),
      coordinate_(coordinate),
      instants_(instants),
      is_strobe_(is_strobe),
      modulo_(std::move(modulo)) {}

void PhaseDrawing::add(const mechanics::State& state) {
  const double q = wrapped(state.q, modulo_)[coordinate_];
  // A wheel that has turned around begins a new curve.
  const bool turned = modulo_.size() > 0 && modulo_[coordinate_] > 0 && row_ > 0 &&
                      std::abs(q - last_) > 0.5 * modulo_[coordinate_];
  points_ += fmt::format("{}{} {}\n", turned ? "\n" : "", q, state.v[coordinate_]);
  last_ = q;
  ++row_;
}

void PhaseDrawing::follow(const mechanics::Motion& motion) {
  const mechanics::Arc& arc = motion.arc();
  for (; row_ < instants_.count() && instants_[row_] < motion.state().t;)
    add(arc.state(std::clamp(instants_[row_] - arc.t, 0.0, arc.length)));
  const bool jumps =
      !is_strobe_ && std::any_of(motion.events().begin(), motion.events().end(),
                                 [](const auto& e) { return e.kind == mechanics::EventKind::impact; });
  if (!jumps || arc.length == 0) return;
  // Both sides of the jump; they are beside the rows that are counted.
  const long rows = row_;
  add(arc.state(arc.length));
  points_ += "\n";
  add(motion.state());
  row_ = rows;
}

void PhaseDrawing::finish(const mechanics::Motion& motion) {
  if (row_ < instants_.count() && instants_[row_] <= motion.state().t) add(motion.state());
}

Drawing PhaseDrawing::drawing(const std::string& title) const {
  const std::string& name = system_.coordinates()[static_cast<std::size_t>(coordinate_)];
  Drawing made;
  made.height = 560;
  made.script = "$points << EOD\n" + points_ + "EOD\n";
  made.script += fmt::format(
      "set title {} font \",11\"\nset xlabel {} font \",10\"\nset ylabel {} font \",10\"\nunset key\n"
      "set grid lc rgb \"#dddddd\" lw 0.5 dt 1\nset border 3 lc rgb \"#666666\" lw 0.7\nset tics nomirror "
      "font "
      "\",9\"\nplot $points using 1:2 with {} lc rgb \"#0072b2\"\n",
      quoted(heading_line(title, made.width - 12)), quoted(name), quoted(name + "'"),
      is_strobe_ ? "points pt 7 ps 0.25" : "lines lw 1.2");
  return made;
}

}  // namespace cli::inline drawings
