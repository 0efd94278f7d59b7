#pragma once

#include <vector>

#include "mechanics/motion/motion.hpp"
#include "tests/mechanics/system_text.hpp"

namespace tests {

/// A motion at its end, with all its events.
struct Followed {
  std::unique_ptr<const mechanics::LagrangianSystem> system;
  mechanics::Motion motion;
  std::vector<mechanics::MotionEvent> events;

  /// The events of one kind.
  std::vector<mechanics::MotionEvent> of(mechanics::EventKind kind) const {
    std::vector<mechanics::MotionEvent> some;
    for (const auto& event : events)
      if (event.kind == kind) some.push_back(event);
    return some;
  }
  const mechanics::State& end() const { return motion.state(); }
};

/// Follows the system from a state to `until`.
inline Followed followed(const SystemText& text, const mechanics::State& state, double until,
                         mechanics::MotionOptions options = {}) {
  auto made = system(text);
  mechanics::Motion motion(*made, state, std::move(options));
  std::vector<mechanics::MotionEvent> events = motion.events();
  while (motion.advance(until)) events.insert(events.end(), motion.events().begin(), motion.events().end());
  return {std::move(made), std::move(motion), std::move(events)};
}

/// A unit mass on a line under a force, from x with the velocity v.
inline Followed pushed(const std::string& force, double x, double v, double until) {
  return followed({{"x"}, "x'^2/2", "", {}, {}, {{"x", force}}, {}}, state({x}, {v}), until);
}

/// The same restitution for each constraint.
inline mechanics::MotionOptions restitution(const SystemText& text, double e) {
  mechanics::MotionOptions options;
  options.restitution =
      mechanics::Vector::Constant(static_cast<mechanics::Index>(text.constraints.size()), e);
  return options;
}

/// m y'^2/2 above a floor, in the weight g.
inline SystemText ball(const std::string& floor = "y >= 0") {
  return {{"y"}, "m*y'^2/2", "m*g*y", {{"m", "2"}, {"g", "9.81"}}, {}, {}, {{"floor", floor}}};
}

}  // namespace tests
