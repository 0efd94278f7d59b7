#include "mechanics/liquid/first_change.hpp"

#include <cmath>
#include <utility>

namespace mechanics::liquid {
namespace {

/// One way from the start.
class Way {
 public:
  Way(const SignedFamily& family, double start, double value, double side, int& trials)
      : family_(family),
        start_(start),
        is_negative_(value < 0),
        side_(side),
        trials_(trials),
        last_{0, std::abs(value)} {}

  /// The first value, nearer than a distance, from which on nothing is shown. What lies within a few of the
  /// finest intervals of that distance is the change there.
  std::optional<double> unshown(double distance) const {
    constexpr double intervals = 4;
    if (!unshown_ || *unshown_ >= distance - intervals * shortest(distance)) return std::nullopt;
    return at(*unshown_);
  }

  /// Distances from `near` to `far`.
  std::optional<std::pair<double, double>> search(double near, double far) {
    if (!is_open_) return std::nullopt;
    return family_.keeps_sign && trials_ < family_.most_trials ? halve(near, far) : walk(near, far);
  }

 private:
  double shortest(double distance) const {
    return family_.finest * std::fmax(distance, std::abs(at(distance)));
  }
  double at(double distance) const { return start_ + side_ * distance; }
  void note(double distance) {
    if (!unshown_) unshown_ = distance;
  }
  /// For certain.
  bool changes(const RoundedValue& found) const {
    return (found.value < 0) != is_negative_ && (found.rounding == 0 || found.is_certain());
  }

  /// The number; none where there is none, or rounding of the size of the values before hides it. Farther on
  /// than two such, or than one of the other sign, nothing can be told.
  std::optional<RoundedValue> known(double parameter) {
    constexpr double most_part = 0.5;
    constexpr int most_hidden = 2;
    const std::optional<RoundedValue> found = family_.value(parameter);
    if (!found || !(found->rounding > most_part * last_.size)) {
      hidden_ = 0;
      return found;
    }
    if ((found->value < 0) != is_negative_ || (!found->is_certain() && ++hidden_ == most_hidden))
      is_open_ = false;
    return found;
  }

  std::optional<std::pair<double, double>> halve(double near, double far) {
    const double a = at(near), b = at(far);
    if (a == b) return std::nullopt;
    if (trials_ >= family_.most_trials) return walk(near, far);
    ++trials_;
    if (family_.keeps_sign(std::fmin(a, b), std::fmax(a, b), is_negative_)) return std::nullopt;
    const double middle = 0.5 * (near + far);
    if (far - near > shortest(far) && near < middle && middle < far) {
      if (const auto found = halve(near, middle)) return found;
      return is_open_ ? halve(middle, far) : std::nullopt;
    }
    ++trials_;
    const std::optional<RoundedValue> found = known(b);
    if (!found) is_open_ = false;
    if (found && changes(*found)) return std::pair{a, b};
    if (found) note(near);  // it comes close to 0, or touches it
    return std::nullopt;
  }

  /// By values alone: three to a doubling of the distance, one where that is a small part of the start.
  std::optional<std::pair<double, double>> walk(double near, double far) {
    note(near);
    constexpr double small_part = 1.0 / 16;
    const int steps = far > small_part * std::abs(start_) ? 3 : 1;
    double before = near;
    for (int k = 1; k <= steps && is_open_; ++k) {
      const double distance = near + (far - near) * k / steps;
      if (const auto found = step(before, distance)) return found;
      before = distance;
    }
    return std::nullopt;
  }

  /// Where the number ends in between, its sign just before that counts; where it comes nearer to 0 and goes
  /// away again, that of the nearest it comes.
  std::optional<std::pair<double, double>> step(double near, double far) {
    const std::optional<RoundedValue> value = known(at(far));
    if (value && changes(*value)) return std::pair{at(near), at(far)};
    if (value) {
      const Seen here{far, std::abs(value->value)};
      const bool dips = before_ && last_.size <= before_->size && last_.size < here.size;
      const auto found = dips ? dip(*before_, last_, here) : std::nullopt;
      before_ = std::exchange(last_, here);
      return found;
    }
    is_open_ = false;
    constexpr int halvings = 40;
    for (int k = 0; k < halvings; ++k) {
      const double middle = 0.5 * (near + far);
      const std::optional<RoundedValue> there = family_.value(at(middle));
      if (there && changes(*there)) return std::pair{at(near), at(middle)};
      (there ? near : far) = middle;
    }
    return std::nullopt;
  }

  struct Seen {
    double distance, size;
  };

  /// The least between three, by parabolas, as long as it may pass 0.
  std::optional<std::pair<double, double>> dip(Seen a, Seen m, Seen b) {
    constexpr int most_values = 16, first_values = 2;
    constexpr double hopeless = 0.5, shortest = 1e-3, golden = 0.38;
    for (int k = 0; k < most_values; ++k) {
      const double low = m.distance - a.distance, high = b.distance - m.distance;
      const double rise_low = (m.size - a.size) / low, rise_high = (b.size - m.size) / high;
      const double bend = (rise_high - rise_low) / (low + high),
                   slope = (rise_low * high + rise_high * low) / (low + high);
      if (!(bend > 0) || (k >= first_values && m.size - slope * slope / (4 * bend) > hopeless * m.size))
        break;
      double by = -slope / (2 * bend);
      if (!(std::abs(by) > shortest * (low + high))) by = golden * (high > low ? high : -low);
      const double here = m.distance + by;
      const std::optional<RoundedValue> value = family_.value(at(here));
      if (!value) break;
      if (changes(*value)) return std::pair{at(by > 0 ? m.distance : a.distance), at(here)};
      const Seen seen{here, std::abs(value->value)};
      if (seen.size < m.size) {
        (by > 0 ? a : b) = m;
        m = seen;
      } else {
        (by > 0 ? b : a) = seen;
      }
    }
    return std::nullopt;
  }

  const SignedFamily& family_;
  double start_;
  bool is_negative_;
  double side_;
  int& trials_;
  bool is_open_ = true;
  int hidden_ = 0;                 // values in a row
  std::optional<double> unshown_;  // the first distance
  std::optional<Seen> before_;     // by values alone, the last two
  Seen last_;
};

std::optional<double> nearer(std::optional<double> a, std::optional<double> b, double start) {
  if (!a || !b) return a ? a : b;
  return std::abs(*a - start) <= std::abs(*b - start) ? a : b;
}

}  // namespace

FirstChange find_first_change(const SignedFamily& family, double start) {
  const std::optional<RoundedValue> first = family.value(start);
  if (!first) return {std::nullopt, start};
  const double size = start == 0 ? 1 : std::abs(start), farthest = 1e6 * size;
  constexpr double growth = 2;
  int trials = 0;
  Way down(family, start, first->value, -1, trials), up(family, start, first->value, 1, trials);
  double near = 0;
  for (double far = 1e-6 * size; far < farthest; near = far, far *= growth) {
    auto between = down.search(near, far);
    const auto above = up.search(near, far);
    if (above && !(between && std::abs(between->second - start) <= std::abs(above->second - start)))
      between = above;
    if (!between) continue;
    const double distance = std::abs(between->second - start);
    return {between, nearer(down.unshown(distance), up.unshown(distance), start)};
  }
  return {std::nullopt, nearer(down.unshown(2 * farthest), up.unshown(2 * farthest), start)};
}

}  // namespace mechanics::liquid
