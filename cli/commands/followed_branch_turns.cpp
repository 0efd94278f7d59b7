#include <algorithm>
#include <cmath>

#include "cli/commands/followed_branch.hpp"

namespace cli::inline commands {
namespace {

/// An impact passes the time of the start if it is no further from it than this part of the period.
constexpr double near_start = 1e-2;

/// A fold is that of the last orbits if it is no further from them than this part of a step.
constexpr double near_fold = 1e-2;

}  // namespace

std::pair<FollowedBranch::Station, double> FollowedBranch::approach(double beyond) {
  Station near = trail_.back();
  double none = beyond;
  constexpr int halvings = 10;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (near.value + none);
    if (auto found = attempt_from_last(middle))
      near = std::move(*found);
    else
      none = middle;
  }
  return {near, none};
}

bool FollowedBranch::across_start(double beyond) {
  const auto [near, none] = approach(beyond);
  const mechanics::Orbit& orbit = near.orbit;
  double nearest = near_start * orbit.period;
  mechanics::State guess = orbit.start;
  for (const mechanics::MotionEvent& impact : orbit.impacts) {
    const double since = std::abs(impact.t - orbit.start.t), left = std::abs(since - orbit.period);
    if (std::min(since, left) >= nearest) continue;
    nearest = std::min(since, left);
    const convex::Vector jump = impact.velocity_after - impact.velocity_before;
    guess.v = orbit.start.v + (since < left ? 1 : -1) * jump;
  }
  if (nearest >= near_start * orbit.period) return false;
  constexpr double short_step = 0.01;
  const auto one = attempt(none, guess, orbit.period);
  if (!one) return false;
  const auto two = attempt(none + short_step * way() * std::abs(range_.step), one->orbit.start, orbit.period);
  if (!two) return false;
  trail_ = {*one, *two};
  stations_.push_back(*two);
  return true;
}

bool FollowedBranch::turn(double beyond) {
  if (asked_.is_free) return false;  // one multiplier is 1 anyhow
  const auto [near, none] = approach(beyond);
  fold_ = mechanics::find_turning_point(family(), near.value, near.orbit);
  const double apart = fold_ ? std::abs(fold_->value - none) : 0;
  if (!fold_ || apart > std::abs(none - near.value) + near_fold * std::abs(range_.step)) return false;
  const Station& last = trail_.front();
  if (along(last.orbit.start, fold_->orbit.start) < 0) fold_->along = -fold_->along;
  row({fold_->value, fold_->orbit}, "fold");
  return true;
}

double FollowedBranch::along(const mechanics::State& from, const mechanics::State& to) const {
  const convex::Index n = from.q.size();
  return fold_->along.head(n).dot(to.q - from.q) + fold_->along.tail(n).dot(to.v - from.v);
}

bool FollowedBranch::begin_behind_fold(double value) {
  const double reach = std::min(std::abs(fold_->value - value), 0.05 * std::abs(range_.step));
  // The parabola from the side that we came from.
  Station from = trail_.back();
  if (std::abs(fold_->value - from.value) < 1e-6 * reach) from = trail_.front();
  const double before = along(from.orbit.start, fold_->orbit.start);
  const double curvature = std::abs(fold_->value - from.value) / (before * before);
  const double distance = std::sqrt(reach / curvature);
  if (!(distance > 0) || !std::isfinite(distance)) return false;
  const auto one = orbit_beside(family(), *fold_, 0.5 * distance),
             four = orbit_beside(family(), *fold_, distance);
  if (!one || !four) return false;
  trail_ = {{one->value, one->orbit}, {four->value, four->orbit}};
  stations_.push_back(trail_.back());
  row(trail_.back(), "");
  return (four->value - one->value) * way() > 0;
}

}  // namespace cli::inline commands
