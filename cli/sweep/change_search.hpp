#pragma once

#include "cli/sweep/sweep_point.hpp"

namespace cli::inline sweeps {

/// Where, between two points of a sweep over one range, the contacts that persist change: the roots of their
/// multipliers, slacks, or of f and df/dt where they leave K, to `change_part` of the range.
class ChangeSearch {
 public:
  ChangeSearch(SweepScene& scene, const std::vector<Watched>& watched, double first, double last)
      : scene_(scene), watched_(watched), range_(std::abs(last - first)) {}

  /// In the order from `from` to `to`, wherever there is an answer on both sides of a change.
  std::vector<double> between(const SweepPoint& from, const SweepPoint& to);

  /// Values nearer to each other than this part of the range are one.
  static constexpr double change_part = 1e-12;

 private:
  std::vector<double> between_answers(const SweepPoint& from, const SweepPoint& to);
  /// The point with an answer that is nearest to where there is none.
  SweepPoint last_answer(SweepPoint with, const SweepPoint& without);
  /// Where to look for a root.
  struct Reach {
    double begin, end;
  };
  void part(SweepPoint& low, SweepPoint& high, double width, Reach all);
  std::vector<double> roots(const SweepPoint& from, const SweepPoint& to, double width, Reach all);
  std::optional<double> root_of(convex::Index c, const SweepPoint& from, const SweepPoint& to, double width,
                                Reach all);
  std::optional<double> end_of_zeros(double x, double step, const std::function<double(double)>& of,
                                     Reach) const;
  std::optional<double> secant(double a, double b, Reach, const std::function<double(double)>& of) const;

  SweepScene& scene_;
  const std::vector<Watched>& watched_;
  double range_;
};

}  // namespace cli::inline sweeps
