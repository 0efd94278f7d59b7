#include "cli/drawing/phase_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

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
  const double q = wrapped(state.q, modulo_)[coordinate_], v = state.v[coordinate_];
  // A wheel that has turned around begins a new curve.
  const bool turned = modulo_.size() > 0 && modulo_[coordinate_] > 0 && rows_ > 0 &&
                      std::abs(q - last_) > 0.5 * modulo_[coordinate_];
  points_ += fmt::format("{}{} {}\n", turned ? "\n" : "", q, v);
  if (rows_ == 0) begin_ = {q, v};
  end_ = {q, v};
  last_ = q;
  ++rows_;
}

void PhaseDrawing::follow(const mechanics::Motion& motion) {
  // Within each step, so that a quick turn is round, as long as the picture stays small.
  constexpr int in_a_step = 24;
  constexpr long most_rows_of_steps = 40000;
  const mechanics::Arc& arc = motion.arc();
  std::vector<double> times;
  for (; instant_ < instants_.count() && instants_[instant_] < motion.state().t; ++instant_)
    times.push_back(std::clamp(instants_[instant_] - arc.t, 0.0, arc.length));
  if (!is_strobe_ && rows_ < most_rows_of_steps)
    for (int k = 0; k < in_a_step; ++k) times.push_back(arc.length * k / in_a_step);
  std::sort(times.begin(), times.end());
  for (const double tau : times) add(arc.state(tau));
  const bool jumps =
      !is_strobe_ && std::any_of(motion.events().begin(), motion.events().end(),
                                 [](const auto& e) { return e.kind == mechanics::EventKind::impact; });
  if (!jumps || arc.length == 0) return;
  // Both sides of the jump.
  add(arc.state(arc.length));
  points_ += "\n";
  add(motion.state());
}

void PhaseDrawing::finish(const mechanics::Motion& motion) {
  if (instant_ < instants_.count() && instants_[instant_] <= motion.state().t) add(motion.state());
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
      "\",9\"\nplot $points using 1:2 with {} lc rgb \"#0072b2\"",
      quoted(heading_line(title, made.width - 12) + (is_strobe_ ? "" : "\n○ begins, ● ends")), quoted(name),
      quoted(name + "'"), is_strobe_ ? "points pt 7 ps 0.25" : "lines lw 1.2");
  if (!is_strobe_)
    made.script += fmt::format(
        ", '-' using 1:2 with points pt 6 ps 1.1 lw 1.5 lc rgb \"#222222\", '-' using 1:2 with points pt 7 "
        "ps 0.9 "
        "lc rgb \"#222222\"\n{} {}\ne\n{} {}\ne\n",
        begin_[0], begin_[1], end_[0], end_[1]);
  return made;
}

}  // namespace cli::inline drawings
