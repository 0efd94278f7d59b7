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
    // Of several contacts that differ each is to have its own change: closer ones are told apart.
    const auto is_narrow = [&](double width) {
      const double apart = std::abs(high.at[0] - low.at[0]);
      return apart <= width && (apart <= change_part / 4 * range_ || differing(low, high).size() <= 1);
    };
    const auto halve = [&](double width) {
      for (int k = 0; k < most_bisections && !is_narrow(width); ++k) {
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
    std::optional<double> change =
        root(low, high, 100 * width, {std::min(last, to.at[0]), std::max(last, to.at[0])});
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

/// The root of what decides about the first contact that differs and has one, within `width` of the two
/// points; within `all` where the contact is told to persist because its slack is within the tolerance: where
/// a slack grows slowly, that is far from where it begins.
std::optional<double> ChangeSearch::root(const SweepPoint& from, const SweepPoint& to, double width,
                                         Reach all) {
  using Margins = SweepScene::Margins;
  const auto number = [&](std::vector<double> Margins::*which, const std::vector<Index>& held, Index c) {
    return [this, which, held, c](double p) {
      try {
        return (scene_.margins({p}, held).*which)[static_cast<std::size_t>(c)];
      } catch (const convex::InvalidInput&) {
        return std::numeric_limits<double>::quiet_NaN();
      }
    };
  };
  const double a = from.at[0], b = to.at[0];
  const Reach near{std::min(a, b) - width, std::max(a, b) + width};
  for (const Index c : differing(from, to)) {
    const bool was = has(from.active, c);
    const SweepPoint &with = was ? from : to, &without = was ? to : from;
    if (!has(without.contacts, c)) {  // it left K
      for (const auto which : {&Margins::f, &Margins::df})
        if (const auto found = secant(b, a, near, number(which, without.active, c))) return found;
      continue;
    }
    const double slack = number(&Margins::slack, without.active, c)(without.at[0]),
                 zero = number(&Margins::zero_slack, without.active, c)(without.at[0]);
    const bool is_hidden = std::abs(slack) <= tight_tolerances * zero;
    const Reach reach = is_hidden ? all : near;
    if (const auto found = secant(a, b, reach, number(&Margins::multiplier, with.active, c))) return found;
    if (const auto found = secant(a, b, reach, number(&Margins::slack, without.active, c))) return found;
  }
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
