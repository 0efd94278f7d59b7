#include <algorithm>
#include <cmath>

#include "cli/commands/followed_branch.hpp"

namespace cli::inline commands {
namespace {

using convex::Index;

/// A fold is that of the last orbits if it is no further from them than this part of a step.
constexpr double near_fold = 1e-2;

/// A graze is that of the last orbits if it is no further behind them than this many times the distance in
/// which the branch is known to end.
constexpr double grazing_reach = 1;

}  // namespace

std::pair<FollowedBranch::Station, double> FollowedBranch::approach(double beyond) {
  Station near = trail_.back();
  double none = beyond;
  constexpr int halvings = 10;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (near.value + none);
    if (auto found = attempt_from_last(middle, deepest - 1))
      near = std::move(*found);
    else
      none = middle;
  }
  return {near, none};
}

bool FollowedBranch::turn(double beyond) {
  const auto [near, none] = approach(beyond);
  fold_ = mechanics::find_turning_point(family(), near.value, near.orbit, std::abs(range_.step));
  const double apart = fold_ ? std::abs(fold_->value - none) : 0;
  if (!fold_ || apart > std::abs(none - near.value) + near_fold * std::abs(range_.step)) return false;
  const Station& last = trail_[trail_.size() - 2];
  if (along(last.orbit.start, fold_->orbit.start) < 0) fold_->along = -fold_->along;
  row({fold_->value, fold_->orbit}, BranchEvent::fold);
  return true;
}

bool FollowedBranch::graze(double beyond, bool& is_on) {
  const std::size_t impacts = trail_.back().orbit.impacts.size();
  const auto go_on = [&](const Station& at) {
    is_on = begin_behind_grazing(at, impacts);
    if (!is_on && points_.back().event == event_name(BranchEvent::opening))
      why_ = "a contact that its orbit holds opens there, and none is found that goes on from it";
    else if (!is_on)
      why_ =
          "its orbit grazes a contact there, and none is found that goes on from it; orbits with the impact "
          "may come back beside those without it: begin at one, found from other states, and its branch "
          "leads here";
    return true;
  };
  if (!trail_.back().orbit.multipliers) return go_on(Station(trail_.back()));  // told already
  const auto [near, none] = approach(beyond);
  const double reach = none + grazing_reach * (none - near.value);
  for (const BranchEvent event : {BranchEvent::opening, BranchEvent::grazing})
    for (Index contact = 0; contact < near.orbit.least_gap.size(); ++contact)
      if (const auto at = locate_grazing(trail_[trail_.size() - 2], near, reach, contact, event)) {
        row(*at, event);
        return go_on(*at);
      }
  for (Index contact = 0; contact < near.orbit.least_gap.size(); ++contact)
    if (const auto at = locate_from_behind(contact)) {
      row(*at, BranchEvent::grazing);
      return go_on(*at);
    }
  return false;
}

/// Behind a graze orbits with the impact leave it by the root of the distance, on either side of its value.
bool FollowedBranch::begin_behind_grazing(const Station& at, std::size_t impacts) {
  const double step = std::abs(range_.step), onward = way();
  const auto distance = [&](const Station& to) {
    return std::hypot((to.orbit.start.q - at.orbit.start.q).norm(),
                      (to.orbit.start.v - at.orbit.start.v).norm());
  };
  constexpr double shorter = 1.0 / 16, nearer = 0.6, as_one = 1e-9;
  const double size = at.orbit.largest.norm();
  for (const double part : {1e-3, 1e-2, 1e-1})
    for (const double side : {onward, -onward}) {
      const auto two = attempt(at.value + side * part * step, at.orbit.start, at.orbit.period);
      if (!two || two->orbit.impacts.size() == impacts) continue;
      const auto one = attempt_along(at, *two, at.value + side * part * shorter * step);
      if (!one || one->orbit.impacts.size() != two->orbit.impacts.size()) continue;
      // Orbits without impacts need not depend on the parameter at all.
      if (!(distance(*one) <= nearer * distance(*two) + as_one * size)) continue;
      if (side != onward) forward_ = -forward_;
      trail_ = {*one, *two};
      last_ = *two;
      choose_instant();
      last_ = trail_.back();
      ++count_;
      row(*last_, BranchEvent::none);
      return true;
    }
  return false;
}

double FollowedBranch::along(const mechanics::State& from, const mechanics::State& to) const {
  const convex::Index n = from.q.size();
  return fold_->along.head(n).dot(to.q - from.q) + fold_->along.tail(n).dot(to.v - from.v);
}

bool FollowedBranch::begin_behind_fold(double value) {
  const double reach = std::min(std::abs(fold_->value - value), 0.05 * std::abs(range_.step));
  // The parabola from the side that we came from.
  Station from = trail_.back();
  if (std::abs(fold_->value - from.value) < 1e-6 * reach) from = trail_[trail_.size() - 2];
  const double before = along(from.orbit.start, fold_->orbit.start);
  const double curvature = std::abs(fold_->value - from.value) / (before * before);
  const double distance = std::sqrt(reach / curvature);
  if (!(distance > 0) || !std::isfinite(distance)) return false;
  const auto one = orbit_beside(family(), *fold_, 0.5 * distance),
             four = orbit_beside(family(), *fold_, distance);
  if (!one || !four) return false;
  trail_ = {{one->value, one->orbit}, {four->value, four->orbit}};
  last_ = trail_.back();
  ++count_;
  row(*last_, BranchEvent::none);
  return (four->value - one->value) * way() > 0;
}

}  // namespace cli::inline commands
