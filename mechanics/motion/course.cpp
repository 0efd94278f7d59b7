#include "mechanics/motion/course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/number_text.hpp"

namespace mechanics::inline motions {
namespace {

MotionOptions checked(MotionOptions options, const LagrangianSystem& system) {
  const auto m = static_cast<Index>(system.constraints().size());
  if (options.restitution.size() == 0) options.restitution = Vector::Zero(m);
  if (options.contact_tolerance.size() == 0)
    options.contact_tolerance = Vector::Constant(m, default_contact_tolerance);
  if (options.restitution.size() != m)
    throw convex::InvalidInput("restitution: one number a constraint is needed");
  if (options.contact_tolerance.size() != m)
    throw convex::InvalidInput("contact_tolerance: one number a constraint is needed");
  for (Index a = 0; a < m; ++a)
    if (!(options.restitution[a] >= 0 && options.restitution[a] <= 1))
      throw convex::InvalidInput("restitution of " + system.constraints()[static_cast<std::size_t>(a)].name +
                                 ": " + number_text(options.restitution[a]) +
                                 " is not from 0 to 1; an impact takes energy, or keeps it");
  if (!(options.tolerance > 0)) throw convex::InvalidInput("tolerance: not a positive number");
  // Doubles have no more to give, and what is told to be beyond it would be their rounding.
  options.tolerance = std::max(options.tolerance, 4 * std::numeric_limits<double>::epsilon());
  if (!(options.step > 0)) throw convex::InvalidInput("step: not a positive number");
  return options;
}

}  // namespace

Motion::Course::Course(const LagrangianSystem& of, MotionOptions chosen)
    : options(checked(std::move(chosen), of)), system(of) {}

bool Motion::Course::may_advance(double until) {
  if (!std::isfinite(until)) throw convex::InvalidInput("until: not a finite time; give one");
  if (status != MotionStatus::done || !(state.t < until)) return false;
  events.clear();
  constexpr double largest = 0x1p500;  // squares of what is larger, as T, leave the range of doubles
  if (state.v.size() > 0 &&
      !(std::max(state.q.cwiseAbs().maxCoeff(), state.v.cwiseAbs().maxCoeff()) <= largest)) {
    stop("at t = " + number_text(state.t) +
         ": coordinates or velocities grow beyond what doubles can square");
    return false;
  }
  if (record.steps < options.step_limit) return true;
  stop("the limit of " + std::to_string(options.step_limit) +
       " steps is reached at t = " + number_text(state.t) +
       (options.method == MotionMethod::event_driven && system.constraints().size() > 1
            ? "; where contacts are very many, method = \"time-stepping\" goes on"
            : ""));
  return false;
}

void Motion::Course::stop(std::string reason) {
  status = MotionStatus::stopped;
  why = std::move(reason);
}

void Motion::Course::remark(RemarkKind kind, std::string what, double loss) {
  const auto said = std::find_if(record.remarks.begin(), record.remarks.end(),
                                 [&](const MotionRemark& one) { return one.kind == kind; });
  if (said == record.remarks.end()) {
    record.remarks.push_back({kind, state.t, std::move(what), 1, state.t, loss});
    return;
  }
  ++said->count;
  said->last = state.t;
  if (!(loss > said->loss)) return;
  said->what = std::move(what);
  said->loss = loss;
}

void Motion::Course::event(EventKind kind, std::vector<Index> constraints, Vector velocity_before) {
  std::sort(constraints.begin(), constraints.end());
  events.push_back({state.t, kind, std::move(constraints), std::move(velocity_before), state.v});
  ++record.events;
  if (kind == EventKind::impact) ++record.impacts;
}

void Motion::Course::tell_endings() {
  while (!endings.empty() && endings.front().t <= state.t) {
    const double now = state.t;
    state.t = endings.front().t;
    event(EventKind::accumulation, endings.front().constraints, state.v);
    state.t = now;
    endings.erase(endings.begin());
  }
}

void Motion::Course::note_penetration(Index a, double f, double scale) {
  if (f >= 0 || -f / scale <= record.largest_penetration) return;
  record.largest_penetration = -f / scale;
  record.most_penetrated = a;
}

}  // namespace mechanics::inline motions
