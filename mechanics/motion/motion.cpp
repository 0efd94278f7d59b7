#include "mechanics/motion/motion.hpp"

#include <limits>

#include "mechanics/motion/event_driven.hpp"
#include "mechanics/motion/time_stepping.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics::inline motions {

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

namespace {

/// To follow each event, rows of contacts are held in full, and series of every constraint: so many numbers
/// are the most that is tried.
constexpr double most_numbers_of_rows = 2e7, most_numbers_of_series = 2e8;

/// Why a scene is not followed event by event; empty if it is.
std::string too_large(const LagrangianSystem& system, const State& state, const MotionOptions& options) {
  const auto n = static_cast<double>(state.q.size());
  const auto m = static_cast<double>(system.constraints().size());
  if (n * m <= most_numbers_of_rows) return "";
  const Index count = options.contact_tolerance.size() == 0 ? static_cast<Index>(m) : 0;
  const Vector tolerance =
      count > 0 ? Vector::Constant(count, default_contact_tolerance) : options.contact_tolerance;
  const Contacts found = contacts(system, state, tolerance, Impending::allowed);
  const auto closed = static_cast<double>(found.present.size() + found.closing.size());
  if (n * closed <= most_numbers_of_rows && n * m <= most_numbers_of_series) return "";
  return number_text(m) + " constraints, of which " + number_text(closed) + " are closed, on " +
         number_text(n) +
         " coordinates are too many to be followed event by event; take method = \"time-stepping\"";
}

}  // namespace

Motion::Motion(const LagrangianSystem& system, const State& state, MotionOptions options) {
  if (options.method == MotionMethod::time_stepping)
    course_ = std::make_unique<TimeStepping>(system, state, std::move(options));
  else if (std::string why = too_large(system, state, options); !why.empty())
    course_ = std::make_unique<NotBegun>(system, state, std::move(options), std::move(why));
  else
    course_ = std::make_unique<EventDriven>(system, state, std::move(options));
}
Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;

bool Motion::advance(double until) { return course_->advance(until); }

void Motion::go_on_in_steps() {
  if (status() != MotionStatus::done || method() == MotionMethod::time_stepping) return;
  MotionOptions options = course_->options;
  options.method = MotionMethod::time_stepping;
  auto stepping = std::make_unique<TimeStepping>(course_->system, course_->state, std::move(options));
  stepping->done = std::move(course_->done);
  stepping->events = std::move(course_->events);
  stepping->endings = std::move(course_->endings);
  stepping->record = std::move(course_->record);
  stepping->acceleration = std::move(course_->acceleration);
  stepping->multipliers = std::move(course_->multipliers);
  course_ = std::move(stepping);
}

const Arc& Motion::arc() const { return course_->done; }
const std::vector<MotionEvent>& Motion::events() const { return course_->events; }
const State& Motion::state() const { return course_->state; }
const Vector& Motion::acceleration() const { return course_->acceleration; }
const Vector& Motion::multipliers() const { return course_->multipliers; }
double Motion::energy() const {
  try {
    return course_->system.energy(course_->state);
  } catch (const convex::InvalidInput&) {
    return std::numeric_limits<double>::infinity();
  }
}
MotionMethod Motion::method() const { return course_->options.method; }
MotionStatus Motion::status() const { return course_->status; }
const std::string& Motion::why() const { return course_->why; }
const std::vector<Index>& Motion::excluding() const { return course_->excluding; }
const MotionRecord& Motion::record() const { return course_->record; }

}  // namespace mechanics::inline motions
