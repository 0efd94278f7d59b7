#include "cli/event_crowd.hpp"

#include "mechanics/number_text.hpp"

namespace cli {
namespace {

/// At this pace a motion has a million events.
constexpr long events_of_crowd = 1000;
constexpr double part_of_motion = 1e-3;

}  // namespace

bool EventCrowd::has_come(const mechanics::Motion& motion) {
  const long events = motion.record().events - counted_;
  if (!what_.empty() || events < events_of_crowd) return false;
  const double t = motion.state().t, within = t - since_;
  counted_ += events;
  since_ = t;
  if (within > part_of_motion * length_ || within > static_cast<double>(events) * step_) return false;
  what_ = std::to_string(events) + " events have come within " + mechanics::number_text(within) +
          " at t = " + mechanics::number_text(t);
  return true;
}

}  // namespace cli
