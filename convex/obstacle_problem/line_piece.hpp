#pragma once

#include "convex/obstacle_problem/line_enclosure.hpp"

namespace convex::inline obstacle_problem {

/// r^power for r in an interval.
class EnclosedWeight {
 public:
  explicit EnclosedWeight(int power) : power_(power) {}
  Interval operator()(const Interval& r) const;
  /// ∫ dt/w from a to a + t; t >= 0, a > 0 unless the power is 0.
  Interval resistance(const Interval& a, const Interval& t) const;
  double resistance(double a, double t) const;
  int power() const { return power_; }

 private:
  int power_;
};

/// [a, a + width], on which -(w p')' = w h. With the M that has (w M')' = w h and M = M' = 0 at a,
///   p(a + t) = p(a) + w p'(a) ∫ dt/w - M(t).
struct LinePieceEnclosure {
  Interval a, width;
  bool is_centre = false;  ///< a = 0 of a weight that vanishes there; w p' = 0
  LineSeries h;
  Interval p, flux;  ///< at a; flux = w p'

  /// Fills in M by h: its Taylor coefficients, and a remainder.
  void integrate(const EnclosedWeight&);
  /// What the remainder may be in M, for a sum to be short enough.
  double remainder() const;
  bool is_finite() const;
  /// At most ∫∫ h⁻ over a part of this length.
  double sag(double length) const;
  const Interval& moment_coefficient(std::size_t j) const { return q_[j]; }

  Interval h_range() const;
  Interval moment(const Interval& t) const;
  /// ∫ w h from a to a + t.
  Interval load(const EnclosedWeight&, const Interval& t) const;
  Interval value(const EnclosedWeight&, const Interval& t) const;
  Interval flux_at(const EnclosedWeight&, const Interval& t) const;

 private:
  std::array<Interval, LineSeries::most + 2> q_{};  // M = Σ q_j t^j, 2 <= j <= degree + 1,
  Interval rest_;  // and this times [0, 1] t^(degree + 2)/((degree + 1)(degree + 2))
};

}  // namespace convex::inline obstacle_problem
