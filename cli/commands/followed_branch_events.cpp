#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/commands/followed_branch.hpp"

namespace cli::inline commands {
namespace {

using convex::Index;

/// Where nothing but counts tells an event, it is known to this part of a step by halving.
constexpr double halved = 1e-11;

/// States of one branch at values that agree to ten digits differ by less than this part.
constexpr double jump = 1e-2;

/// A multiplier that moves so far between values that are nearly one crosses nothing that is told: beside a
/// graze it grows like the inverse of a root.
constexpr double leap = 0.1;

/// A multiplier is on the unit circle, and a value settled, but for rounding.
constexpr double on_circle = 1e-13, settled = 1e-14;

double apart(const mechanics::State& x, const mechanics::State& y) {
  return std::hypot((x.q - y.q).norm(), (x.v - y.v).norm());
}

/// The x at which y is 0 by the polynomial x(y) through the last points (Neville).
double where_zero(const std::vector<std::pair<double, double>>& points) {
  constexpr std::size_t most_points = 5;
  const std::size_t count = std::min(points.size(), most_points), first = points.size() - count;
  std::vector<double> x;
  for (std::size_t i = 0; i < count; ++i) x.push_back(points[first + i].first);
  const auto y = [&](std::size_t i) { return points[first + i].second; };
  for (std::size_t width = 1; width < count; ++width)
    for (std::size_t i = 0; i + width < count; ++i)
      x[i] = (y(i) * x[i + 1] - y(i + width) * x[i]) / (y(i) - y(i + width));
  return x[0];
}

}  // namespace

/// A secant of the distance from the unit circle, held between the two orbits (the Illinois rule, Dowell and
/// Jarratt 1971); halving where there is none.
std::optional<FollowedBranch::Passage> FollowedBranch::locate(Station a, Station b, BranchEvent& event) {
  if (event == BranchEvent::opening) {
    const Index contact = opened_contact(a.orbit, b.orbit);
    const auto k = static_cast<std::size_t>(contact);
    const bool from_a = a.orbit.releases[k] < b.orbit.releases[k];
    const Station &here = from_a ? a : b, &there = from_a ? b : a;
    for (const double part : {-0.1, 0.1}) {  // beside the last orbit that holds the contact
      const auto beside = attempt_along(here, there, here.value + part * (there.value - here.value));
      if (!beside || beside->orbit.releases != here.orbit.releases) continue;
      const Station &first = part < 0 ? *beside : here, &second = part < 0 ? here : *beside;
      if (const auto at = locate_grazing(first, second, there.value, contact, event))
        return behind(*at, a, b, event);
    }
    return std::nullopt;
  }
  if (event == BranchEvent::grazing)
    if (const Index contact = grazed(a, b); contact >= 0) {
      bool has_none = false;  // told by where the gap, or the speed, goes
      for (const bool from_a : {true, false}) {
        // From the side without the impact, and otherwise from the one with it.
        const Station &here = (impacts_of(a.orbit, contact, b.orbit) <
                               impacts_of(b.orbit, contact, a.orbit)) == from_a
                                  ? a
                                  : b,
                      &there = &here == &a ? b : a;
        const auto second = attempt_along(here, there, 0.9 * here.value + 0.1 * there.value);
        if (!second || second->orbit.impacts.size() != here.orbit.impacts.size()) continue;
        if (const auto at = locate_grazing(here, *second, there.value, contact))
          return behind(*at, a, b, event);
        has_none = true;
      }
      if (has_none) return std::nullopt;
    }
  const Station end = b;
  Crossing crossing(event, a.orbit, b.orbit, asked_.is_free);
  auto left = crossing(a.orbit), right = crossing(b.orbit);
  const double step = std::abs(range_.step);
  bool is_located = false;
  int stays = 0;  // the end that has not moved, by its sign, and how often
  constexpr int most_halvings = 200;
  for (int i = 0; i < most_halvings && std::abs(b.value - a.value) > halved * step; ++i) {
    const bool by_secant = left && right && *left * *right < 0 && i % 4 != 3;
    const double middle =
        by_secant ? a.value - *left * (b.value - a.value) / (*right - *left) : 0.5 * (a.value + b.value);
    if (!((middle - a.value) * (middle - b.value) < 0)) break;
    auto found = attempt_along(a, b, middle);
    if (!found) found = attempt(middle, a.orbit.start, a.orbit.period);
    if (!found) break;
    const BranchEvent here = event_between(a.orbit, found->orbit, asked_.is_free);
    if (here != BranchEvent::none && here != event) {
      event = here;
      crossing = Crossing(event, a.orbit, found->orbit, asked_.is_free);
      b = std::move(*found);
      left = crossing(a.orbit);
      right = crossing(b.orbit);
      stays = 0;
      is_located = true;
      continue;
    }
    const auto distance = crossing(found->orbit);
    if (distance && std::abs(*distance) <= on_circle * (1 + found->orbit.circle_width / on_circle / 16))
      return behind(*found, a, end, event);
    const bool is_before = distance && left && right ? *distance * *left > 0 : here == BranchEvent::none;
    if (is_before) {
      a = std::move(*found);
      left = distance;
      if (stays > 0 && right) *right *= 0.5;
      stays = 1;
    } else {
      b = std::move(*found);
      right = distance;
      if (stays < 0 && left) *left *= 0.5;
      stays = -1;
      is_located = true;
    }
  }
  // A branch is one curve: what jumps between two values that are one but for rounding is not an event of it.
  const double away = apart(a.orbit.start, b.orbit.start);
  is_lost_ = is_located && away > jump * b.orbit.largest.norm();
  if (is_lost_) return std::nullopt;
  constexpr double near = 1e-3;  // part of a step: else it is not known well enough for a row
  if (std::abs(b.value - a.value) > near * step) return std::nullopt;
  const auto before = crossing(a.orbit), after = crossing(b.orbit);
  if (before && after && std::abs(*after - *before) > leap) event = BranchEvent::none;
  return Passage{b, b};
}

FollowedBranch::Passage FollowedBranch::behind(const Station& at, const Station& before, const Station& after,
                                               BranchEvent event) {
  for (double part = 1e-9; part < 1; part *= 8) {
    const auto found = attempt_along(at, after, at.value + part * (after.value - at.value));
    if (found && event_between(before.orbit, found->orbit, asked_.is_free) == event) return {at, *found};
  }
  return {at, after};
}

Index FollowedBranch::grazed(const Station& a, const Station& b) {
  for (Index contact = 0; contact < a.orbit.least_gap.size(); ++contact)
    if (impacts_of(a.orbit, contact, b.orbit) != impacts_of(b.orbit, contact, a.orbit)) return contact;
  return -1;
}

std::optional<FollowedBranch::Station> FollowedBranch::locate_grazing(const Station& a, const Station& b,
                                                                      double beyond, Index contact,
                                                                      BranchEvent event) {
  const bool opens = event == BranchEvent::opening,
             has_impact = a.orbit.least_gap[contact] == std::numeric_limits<double>::infinity();
  const auto nearness = [&](const mechanics::Orbit& orbit) {
    return opens        ? orbit.least_pressing[contact]
           : has_impact ? orbit.least_closing[contact]
                        : orbit.least_gap[contact];
  };
  const auto is_alike = [&](const mechanics::Orbit& orbit) {
    return opens ? orbit.releases == a.orbit.releases : orbit.impacts.size() == a.orbit.impacts.size();
  };
  std::vector<std::pair<double, double>> points{{a.value, nearness(a.orbit)}, {b.value, nearness(b.orbit)}};
  std::vector<Station> met{a, b};
  double before = std::numeric_limits<double>::quiet_NaN();
  constexpr int most_steps = 24;
  for (int i = 0; i < most_steps; ++i) {
    const Station now = met.back();
    for (const auto& [value, y] : points)
      if (!std::isfinite(y)) return std::nullopt;
    const double zero = where_zero(points);
    const bool is_between = (zero - now.value) * (zero - beyond) < 0;
    if (is_between && std::abs(zero - before) <= settled * std::max(std::abs(zero), std::abs(range_.step)) &&
        std::abs(zero - now.value) <= 1e-3 * std::abs(range_.step))
      return Station{zero, now.orbit};
    before = is_between ? zero : before;
    constexpr double short_of = 0.1;
    const double next = is_between ? zero + short_of * (now.value - zero) : 0.5 * (now.value + beyond);
    if (next == now.value || next == beyond || points.back().second == 0) {
      if (!is_between || !(std::abs(zero - now.value) <= halved * std::abs(range_.step))) return std::nullopt;
      return Station{zero, now.orbit};
    }
    const auto is_nearer = [&](const std::optional<Station>& found) {
      return found && is_alike(found->orbit) && nearness(found->orbit) < points.back().second;
    };
    auto found = attempt_along(met[met.size() - 2], now, next);
    if (!is_nearer(found)) found = attempt_by_polynomial(met, next);
    if (!is_nearer(found)) {
      beyond = next;
      continue;
    }
    points.emplace_back(found->value, nearness(found->orbit));
    met.push_back(std::move(*found));
  }
  return std::nullopt;
}

std::optional<FollowedBranch::Station> FollowedBranch::locate_from_behind(Index contact) {
  if (trail_.size() < 3) return std::nullopt;
  std::vector<std::pair<double, double>> speeds;
  for (const Station& station : trail_)
    speeds.emplace_back(station.value, station.orbit.least_closing[contact]);
  const Station &last = trail_.back(), &before = trail_[trail_.size() - 2];
  const double falls = speeds[speeds.size() - 2].second - speeds.back().second;
  if (!(falls > 0 && std::isfinite(falls))) return std::nullopt;
  const double zero = where_zero(speeds), ahead = zero - last.value;
  constexpr double farthest = 4;  // times the last step
  if (!(ahead * (last.value - before.value) > 0) ||
      !(std::abs(ahead) <= farthest * std::abs(last.value - before.value)))
    return std::nullopt;
  const auto lacks_it = [&](const std::optional<Station>& found) {
    return found && found->orbit.impacts.size() + 1 == last.orbit.impacts.size() &&
           grazed(last, *found) == contact;
  };
  for (const double part : {1.0, 0.1, 1e-2})
    for (const double side : {-1.0, 1.0}) {
      const double far = zero + side * part * ahead, near = zero + 0.5 * side * part * ahead;
      const auto one = attempt(far, last.orbit.start, last.orbit.period);
      if (!lacks_it(one)) continue;
      const auto two = attempt_along(last, *one, near);
      if (!lacks_it(two)) continue;
      const auto at = locate_grazing(*one, *two, zero - side * part * ahead, contact);
      // Where the speed leads, and not another graze.
      if (at && std::abs(at->value - zero) <= 0.5 * std::abs(ahead)) return at;
    }
  return std::nullopt;
}

}  // namespace cli::inline commands
