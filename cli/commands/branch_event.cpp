#include "cli/commands/branch_event.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>

namespace cli::inline commands {
namespace {

/// How far multipliers that may cross there are outside the unit circle, the outermost first.
std::vector<double> distances(BranchEvent event, const mechanics::Orbit& orbit, bool is_free) {
  std::vector<double> found;
  if (!orbit.multipliers) return found;
  for (const std::complex<double>& m : mechanics::multipliers_across(orbit, is_free)) {
    if (event == BranchEvent::torus && m.imag() > 0) found.push_back(std::abs(m) - 1);
    if (event == BranchEvent::flip && m.imag() == 0) found.push_back(-1 - m.real());
    if (event == BranchEvent::branching && m.imag() == 0) found.push_back(m.real() - 1);
  }
  std::sort(found.begin(), found.end(), std::greater<>());
  return found;
}

std::size_t outside(BranchEvent event, const mechanics::Orbit& orbit, bool is_free) {
  const std::vector<double> all = distances(event, orbit, is_free);
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [&](double d) { return d > orbit.circle_width; }));
}

}  // namespace

const char* table_name(BranchEvent event) { return event == BranchEvent::branching ? "" : event_name(event); }

const char* event_name(BranchEvent event) {
  switch (event) {
    case BranchEvent::fold:
      return "fold";
    case BranchEvent::branching:
      return "branching";
    case BranchEvent::flip:
      return "flip";
    case BranchEvent::torus:
      return "torus";
    case BranchEvent::grazing:
      return "grazing";
    case BranchEvent::opening:
      return "opening";
    case BranchEvent::none:
      return "";
  }
  return "";
}

long impacts_of(const mechanics::Orbit& orbit, convex::Index constraint, const mechanics::Orbit& other) {
  const auto has = [&](const std::vector<convex::Index>& all) {
    return std::find(all.begin(), all.end(), constraint) != all.end();
  };
  if (has(orbit.accumulating) || has(other.accumulating)) return 0;
  return std::count_if(orbit.impacts.begin(), orbit.impacts.end(),
                       [&](const mechanics::MotionEvent& impact) { return has(impact.constraints); });
}

convex::Index opened_contact(const mechanics::Orbit& before, const mechanics::Orbit& now) {
  for (std::size_t a = 0; a < std::min(before.releases.size(), now.releases.size()); ++a) {
    const mechanics::Orbit& holds = before.releases[a] < now.releases[a] ? before : now;
    const auto contact = static_cast<convex::Index>(a);
    if (before.releases[a] != now.releases[a] && std::isfinite(holds.least_pressing[contact])) return contact;
  }
  return -1;
}

BranchEvent event_between(const mechanics::Orbit& before, const mechanics::Orbit& now, bool is_free) {
  if (opened_contact(before, now) >= 0) return BranchEvent::opening;
  const bool is_crowd = !before.accumulating.empty() || !now.accumulating.empty();
  bool has_other_impacts = !is_crowd && before.impacts.size() != now.impacts.size();
  for (convex::Index a = 0; a < now.least_gap.size(); ++a)
    has_other_impacts = has_other_impacts || impacts_of(before, a, now) != impacts_of(now, a, before);
  if (has_other_impacts || !before.multipliers || !now.multipliers) return BranchEvent::grazing;
  const auto all_outside = [&](const mechanics::Orbit& orbit) {
    return outside(BranchEvent::flip, orbit, is_free) + outside(BranchEvent::branching, orbit, is_free) +
           2 * outside(BranchEvent::torus, orbit, is_free);
  };
  // Two that meet outside the circle and part as another kind cross nothing.
  if (all_outside(before) == all_outside(now)) return BranchEvent::none;
  for (const BranchEvent event : {BranchEvent::torus, BranchEvent::flip, BranchEvent::branching})
    if (outside(event, before, is_free) != outside(event, now, is_free)) return event;
  return BranchEvent::none;
}

Crossing::Crossing(BranchEvent event, const mechanics::Orbit& before, const mechanics::Orbit& now,
                   bool is_free)
    : event_(event),
      is_free_(is_free),
      which_(std::max(outside(event, before, is_free), outside(event, now, is_free))) {}

std::optional<double> Crossing::operator()(const mechanics::Orbit& orbit) const {
  const std::vector<double> all = distances(event_, orbit, is_free_);
  if (which_ == 0 || all.size() < which_) return std::nullopt;
  return all[which_ - 1];
}

}  // namespace cli::inline commands
