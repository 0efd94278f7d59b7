#include "mechanics/motion/closed_impacts.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/motion/lagrange_equations.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics::inline motions {
namespace {

/// An impact that changes velocities by more than this part of the largest on the way is seen in positions
/// that agree to the tolerance of an orbit, 1e-10: its speed has four digits then.
constexpr double slow = 1e-3;

/// The speed of an impact is the same a period later, to this part.
constexpr double repeated = 1e-2;

bool ends_in_rest(const std::vector<MotionEvent>& events, Index a) {
  return std::any_of(events.begin(), events.end(), [&](const MotionEvent& event) {
    return event.kind == EventKind::accumulation &&
           std::find(event.constraints.begin(), event.constraints.end(), a) != event.constraints.end();
  });
}

/// The impacts of contacts that do not come to rest by infinitely many.
std::vector<const MotionEvent*> single_impacts(const std::vector<MotionEvent>& events) {
  std::vector<const MotionEvent*> found;
  for (const MotionEvent& event : events)
    if (event.kind == EventKind::impact && std::none_of(event.constraints.begin(), event.constraints.end(),
                                                        [&](Index a) { return ends_in_rest(events, a); }))
      found.push_back(&event);
  return found;
}

/// e = 1 at all of its contacts.
bool gives_all_back(const MotionEvent& impact, const MotionOptions& options) {
  return options.restitution.size() > 0 && std::all_of(impact.constraints.begin(), impact.constraints.end(),
                                                       [&](Index a) { return options.restitution[a] == 1; });
}

std::string names(const LagrangianSystem& system, const MotionEvent& event) {
  std::string all;
  for (const Index a : event.constraints)
    all += (all.empty() ? "" : " and ") + system.constraints()[static_cast<std::size_t>(a)].name;
  return all;
}

}  // namespace

bool keeps_energy_between_impacts(const LagrangianSystem& system) {
  const expression::LagrangianModel& model = system.model();
  return !system.equations_of_motion().series.steps.uses_time &&
         std::all_of(model.forces.begin(), model.forces.end(),
                     [](expression::NodeId Q) { return Q == expression::no_node; });
}

std::string lost_energy(const LagrangianSystem& system, const MotionOptions& options,
                        const std::vector<MotionEvent>& events) {
  if (!keeps_energy_between_impacts(system)) return {};
  for (const MotionEvent& event : events)
    if (event.kind == EventKind::impact && !gives_all_back(event, options) &&
        event.velocity_after != event.velocity_before)
      return "the motion that comes nearest to its start loses energy in its impact with " +
             names(system, event) + " at t = " + number_text(event.t) +
             ", and nothing brings it back: orbits here do not reach " + names(system, event) +
             ", or graze it; begin at such a motion, or with a restitution of 1";
  return {};
}

std::string why_not_repeated(const LagrangianSystem& system, const OrbitQuestion& question,
                             const PeriodMap& map, const Flight& flight, const Vector& x, double period) {
  const std::vector<MotionEvent> events = flight.events();
  if (std::string lost = lost_energy(system, question.motion, events); !lost.empty()) return lost;
  const Index n = x.size() / 2;
  const auto jump = [&](const MotionEvent& event) {
    double part = 0;
    for (Index i = 0; i < n; ++i)
      if (flight.largest[n + i] > 0)
        part = std::max(part,
                        std::abs(event.velocity_after[i] - event.velocity_before[i]) / flight.largest[n + i]);
    return part;
  };
  const std::vector<const MotionEvent*> impacts = single_impacts(events);
  if (std::none_of(impacts.begin(), impacts.end(), [&](const auto* event) { return jump(*event) <= slow; }))
    return {};
  const Flight later = map.fly(x + map.miss(flight, x), period);
  const std::vector<MotionEvent> events_later = later.events();
  const std::vector<const MotionEvent*> impacts_later = single_impacts(events_later);
  for (std::size_t k = 0; k < impacts.size(); ++k) {
    const double before = jump(*impacts[k]);
    if (before > slow) continue;
    const bool is_there = later.arrives && impacts_later.size() == impacts.size() &&
                          impacts_later[k]->constraints == impacts[k]->constraints;
    if (is_there && std::abs(jump(*impacts_later[k]) - before) <= repeated * before) continue;
    return "the motion that comes nearest to its start grazes " + names(system, *impacts[k]) +
           " at t = " + number_text(impacts[k]->t) +
           ": whether it strikes there, and how fast, is another answer a period later; begin at a motion "
           "that "
           "strikes faster, or does not reach it";
  }
  return {};
}

}  // namespace mechanics::inline motions
