#include "mechanics/motion/motion.hpp"

#include "mechanics/motion/event_driven.hpp"
#include "mechanics/motion/time_stepping.hpp"

namespace mechanics {

const char* name(EventKind kind) {
  switch (kind) {
    case EventKind::impact:
      return "impact";
    case EventKind::contact:
      return "contact";
    case EventKind::release:
      return "release";
    case EventKind::accumulation:
      return "accumulation";
    case EventKind::branch:
      return "branch";
  }
  return "";
}

const char* name(MotionMethod method) {
  return method == MotionMethod::event_driven ? "event-driven" : "time-stepping";
}

Motion::Motion(const LagrangianSystem& system, const State& state, MotionOptions options) {
  if (options.method == MotionMethod::time_stepping)
    course_ = std::make_unique<TimeStepping>(system, state, std::move(options));
  else
    course_ = std::make_unique<EventDriven>(system, state, std::move(options));
}
Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;

bool Motion::advance(double until) { return course_->advance(until); }
const Arc& Motion::arc() const { return course_->done; }
const std::vector<MotionEvent>& Motion::events() const { return course_->events; }
const State& Motion::state() const { return course_->state; }
const Vector& Motion::acceleration() const { return course_->acceleration; }
const Vector& Motion::multipliers() const { return course_->multipliers; }
double Motion::energy() const { return course_->system.energy(course_->state); }
MotionMethod Motion::method() const { return course_->options.method; }
MotionStatus Motion::status() const { return course_->status; }
const std::string& Motion::why() const { return course_->why; }
const std::vector<Index>& Motion::excluding() const { return course_->excluding; }
const MotionRecord& Motion::record() const { return course_->record; }

}  // namespace mechanics
