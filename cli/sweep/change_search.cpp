#include "cli/sweep/change_search.hpp"

#include <algorithm>
#include <cmath>

namespace cli::inline sweeps {
namespace {

using convex::Index;

/// Bisection leaves so much of the range; a root is then found from the two ends.
constexpr double bracket_part = 1e-7;
/// A slack within so many times what is 0 by the tolerance, where a contact opens, may have grown before.
constexpr double tight_tolerances = 4;
/// Roots closer than this part of the range are of one change.
constexpr double together_part = 2e-11;
constexpr int most_bisections = 200, most_secants = 60, most_changes = 1000;

bool has(const std::vector<Index>& sorted, Index a) {
  return std::binary_search(sorted.begin(), sorted.end(), a);
}

/// The contacts that persist at one of two points alone.
std::vector<Index> differing(const SweepPoint& one, const SweepPoint& other) {
  std::vector<Index> found;
  std::set_symmetric_difference(one.active.begin(), one.active.end(), other.active.begin(),
                                other.active.end(), std::back_inserter(found));
  return found;
}

}  // namespace

std::vector<double> ChangeSearch::between(const SweepPoint& from, const SweepPoint& to) {
  if (!from.has_answer() && !to.has_answer()) return {};
  if (!from.has_answer()) return between_answers(last_answer(to, from), to);
  if (!to.has_answer()) return between_answers(from, last_answer(from, to));
  return between_answers(from, to);
}

SweepPoint ChangeSearch::last_answer(SweepPoint with, const SweepPoint& without) {
  double end = without.at[0];
  while (std::abs(end - with.at[0]) > change_part / 4 * range_) {
    const double middle = with.at[0] + (end - with.at[0]) / 2;
    if (middle == with.at[0] || middle == end) break;
    SweepPoint point = scene_.solve({middle}, watched_);
    if (point.has_answer())
      with = std::move(point);
    else
      end = middle;
  }
  return with;
}

std::vector<double> ChangeSearch::between_answers(const SweepPoint& from, const SweepPoint& to) {
  std::vector<double> found;
  SweepPoint low = from;
  double last = from.at[0];
  while (low.active != to.active && static_cast<int>(found.size()) < most_changes) {
    SweepPoint high = to;
    std::optional<SweepPoint> gap;  // without an answer, between the two
    const auto halve = [&](double width) {
      for (int k = 0; k < most_bisections && std::abs(high.at[0] - low.at[0]) > width; ++k) {
        const double middle = low.at[0] + (high.at[0] - low.at[0]) / 2;
        if (middle == low.at[0] || middle == high.at[0]) return true;
        SweepPoint point = scene_.solve({middle}, watched_);
        if (!point.has_answer()) {
          gap = std::move(point);
          return false;
        }
        (point.active == low.active ? low : high) = std::move(point);
      }
      return true;
    };
    const auto over_gap = [&] {
      const std::vector<double> before = between_answers(low, last_answer(low, *gap));
      found.insert(found.end(), before.begin(), before.end());
      low = last_answer(high, *gap);
    };
    if (!halve(bracket_part * range_)) {
      over_gap();
      continue;
    }
    const double width = std::max(std::abs(high.at[0] - low.at[0]), bracket_part * range_);
    const Reach all{std::min(last, to.at[0]), std::max(last, to.at[0])};
    part(low, high, 100 * width, all);
    const std::vector<double> changes = roots(low, high, 100 * width, all);
    std::optional<double> change = changes.empty() ? std::nullopt : std::optional(changes.front());
    if (!change) {
      if (!halve(change_part / 4 * range_)) {
        over_gap();
        continue;
      }
      change = low.at[0] + (high.at[0] - low.at[0]) / 2;
    }
    found.push_back(*change);
    last = *change;
    low = high;
  }
  return found;
}

/// Where several contacts differ, parts what lies between at the widest gap of their roots, until those that
/// are left change together.
void ChangeSearch::part(SweepPoint& low, SweepPoint& high, double width, Reach all) {
  constexpr int most_parts = 20;
  for (int k = 0; k < most_parts && differing(low, high).size() > 1; ++k) {
    std::vector<double> found = roots(low, high, width, all);
    std::sort(found.begin(), found.end());
    double widest = together_part * range_, middle = 0;
    for (std::size_t r = 1; r < found.size(); ++r)
      if (found[r] - found[r - 1] > widest) {
        widest = found[r] - found[r - 1];
        middle = found[r - 1] + widest / 2;
      }
    if (!(widest > together_part * range_)) return;
    SweepPoint point = scene_.solve({middle}, watched_);
    if (!point.has_answer()) return;
    (point.active == low.active ? low : high) = std::move(point);
  }
}

/// The roots of what decides about the contacts that differ, where they have one.
std::vector<double> ChangeSearch::roots(const SweepPoint& from, const SweepPoint& to, double width,
                                        Reach all) {
  std::vector<double> found;
  for (const Index c : differing(from, to))
    if (const auto root = root_of(c, from, to, width, all)) found.push_back(*root);
  return found;
}

/// The root of what decides about a contact, within `width` of the two points; within `all` where the contact
/// is told to persist because its slack is within the tolerance: where a slack grows slowly, that is far from
/// where it begins.
std::optional<double> ChangeSearch::root_of(Index c, const SweepPoint& from, const SweepPoint& to,
                                            double width, Reach all) {
  using Margins = SweepScene::Margins;
  const auto number = [&](std::vector<double> Margins::*which, const std::vector<Index>& held) {
    return [this, which, held, c](double p) {
      try {
        return (scene_.margins({p}, held).*which)[static_cast<std::size_t>(c)];
      } catch (const convex::InvalidInput&) {
        return std::numeric_limits<double>::quiet_NaN();
      }
    };
  };
  // Closer to each other they would differ by rounding alone.
  const double way = to.at[0] - from.at[0], least = bracket_part * range_,
               spread = std::abs(way) < least / 2 ? std::copysign(least, way) / 2 : 0;
  const double a = from.at[0] - spread, b = to.at[0] + spread;
  const Reach near{std::min(a, b) - width, std::max(a, b) + width};
  const bool was = has(from.active, c);
  const SweepPoint &with = was ? from : to, &without = was ? to : from;
  if (!has(without.contacts, c)) {  // it left K
    for (const auto which : {&Margins::f, &Margins::df})
      if (const auto found = secant(b, a, near, number(which, without.active))) return found;
    return std::nullopt;
  }
  const auto multiplier = number(&Margins::multiplier, with.active),
             slack = number(&Margins::slack, without.active),
             zero = number(&Margins::zero_slack, without.active);
  const auto is_hidden = [&](double p) { return std::abs(slack(p)) <= tight_tolerances * zero(p); };
  for (const auto& margin : {multiplier, slack})
    if (const auto found = secant(a, b, near, margin)) return found;
  if (!is_hidden(without.at[0])) return std::nullopt;
  for (const auto& margin : {multiplier, slack})
    if (const auto found = secant(a, b, all, margin); found && is_hidden(*found)) return found;
  return std::nullopt;
}

/// Where a function that is 0 on one side begins to differ from 0: from its tangent on the other, at `x` and
/// beyond, where it is straight. `step`: away from the zeros.
std::optional<double> ChangeSearch::end_of_zeros(double x, double step,
                                                 const std::function<double(double)>& of, Reach reach) const {
  constexpr double straight = 1e-4;  // of the root's distance, which is about a step
  const double f0 = of(x), f1 = of(x + step), f2 = of(x + 2 * step), rise = f1 - f0;
  if (!(std::abs(f2 - f1 - rise) <= straight * std::abs(rise)) || rise == 0) return std::nullopt;
  const double root = x - f0 * step / rise;
  return root >= reach.begin && root <= reach.end ? std::optional(root) : std::nullopt;
}

/// None where the steps leave the reach or do not end.
std::optional<double> ChangeSearch::secant(double a, double b, Reach reach,
                                           const std::function<double(double)>& of) const {
  double fa = of(a), fb = of(b);
  if (fa == 0 && fb == 0) return std::nullopt;
  if (fa == 0 || fb == 0)
    return fa == 0 ? end_of_zeros(b, b - a, of, reach) : end_of_zeros(a, a - b, of, reach);
  for (int k = 0; k < most_secants; ++k) {
    if (fb == 0) return b;
    if (fa == 0) return a;
    const double next = b - fb * (b - a) / (fb - fa);
    if (!(next >= reach.begin && next <= reach.end)) return std::nullopt;
    if (std::abs(next - b) <= 1e-16 * std::max(range_, std::abs(b)) || next == a) return next;
    a = b;
    fa = fb;
    b = next;
    fb = of(b);
    if (std::isfinite(fb) && fb == fa) break;
  }
  // Steps that are all rounding by now: as good as it gets.
  return std::abs(b - a) <= change_part / 4 * range_ ? std::optional(b) : std::nullopt;
}

}  // namespace cli::inline sweeps
