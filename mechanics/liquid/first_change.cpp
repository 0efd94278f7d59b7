#include "mechanics/liquid/first_change.hpp"

#include <cmath>

namespace mechanics::liquid {
namespace {

/// One way from the start.
class Way {
 public:
  Way(const SignedFamily& family, double start, bool is_negative, double side, int& trials)
      : family_(family), start_(start), is_negative_(is_negative), side_(side), trials_(trials) {}

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
  bool changes(double value) const { return (value < 0) != is_negative_; }

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
    const std::optional<double> value = family_.value(b);
    if (!value) is_open_ = false;
    if (value && changes(*value)) return std::pair{a, b};
    if (value) note(near);  // it comes close to 0, or touches it
    return std::nullopt;
  }

  /// By values alone.
  std::optional<std::pair<double, double>> walk(double near, double far) {
    note(near);
    constexpr int steps = 5;
    double before = near;
    for (int k = 1; k <= steps && is_open_; ++k) {
      const double distance = near + (far - near) * k / steps;
      if (const auto found = step(before, distance)) return found;
      before = distance;
    }
    return std::nullopt;
  }

  /// Where the number ends in between, its sign just before that counts.
  std::optional<std::pair<double, double>> step(double near, double far) {
    const std::optional<double> value = family_.value(at(far));
    if (value) return changes(*value) ? std::optional(std::pair{at(near), at(far)}) : std::nullopt;
    is_open_ = false;
    constexpr int halvings = 40;
    for (int k = 0; k < halvings; ++k) {
      const double middle = 0.5 * (near + far);
      const std::optional<double> there = family_.value(at(middle));
      if (there && changes(*there)) return std::pair{at(near), at(middle)};
      (there ? near : far) = middle;
    }
    return std::nullopt;
  }

  const SignedFamily& family_;
  double start_;
  bool is_negative_;
  double side_;
  int& trials_;
  bool is_open_ = true;
  std::optional<double> unshown_;  // the first distance
};

std::optional<double> nearer(std::optional<double> a, std::optional<double> b, double start) {
  if (!a || !b) return a ? a : b;
  return std::abs(*a - start) <= std::abs(*b - start) ? a : b;
}

}  // namespace

FirstChange find_first_change(const SignedFamily& family, double start) {
  const std::optional<double> first = family.value(start);
  if (!first) return {std::nullopt, start};
  const double size = start == 0 ? 1 : std::abs(start), growth = family.keeps_sign ? 2 : 1.5,
               farthest = 1e6 * size;
  int trials = 0;
  Way down(family, start, *first < 0, -1, trials), up(family, start, *first < 0, 1, trials);
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
