#pragma once

#include <array>
#include <optional>

#include "convex/interval.hpp"
#include "convex/obstacle_problem/line_obstacle.hpp"

namespace convex::inline obstacle_problem {

/// A function near a, for 0 <= t <= width: f(a + t) = Σ_{j<degree} c_j t^j + γ(t) t^degree, where c_j are
/// numbers in the intervals and γ(t) is in c_degree throughout.
struct LineSeries {
  static constexpr std::size_t most = 12;
  std::size_t degree = 0;
  std::array<Interval, most + 1> c{};
  /// Of an f without bound, degree 0: all that its integral over a part of the piece may be, 0 included.
  std::optional<Interval> mass = {};
};

/// A LineObstacle whose numbers are known to intervals. `h(a, width)` encloses h from any point of a on.
struct EnclosedLineObstacle {
  int power = 0;
  Interval low, high;
  LineEnd::Kind low_kind = LineEnd::Kind::value, high_kind = LineEnd::Kind::value;
  Interval at_low, at_high;
  std::function<LineSeries(const Interval& a, double width)> h;  ///< with a mass on lines of power 0 alone
};

/// A pressure with a proved bound of its distance from the solution, in the largest norm.
struct LineEnclosure {
  double error_bound = 0;
  std::function<double(double)> p;
};

/// Let p be, between the points where `found` has p = 0, the exact solution of -(w p')' = w h, and 0 in the
/// cavity. Then max(p, 0) is a subsolution. With m the mass that p lacks as a supersolution (w h⁺ in the
/// cavity, kinks upwards at its edges) and ε what p is below 0, p + ε + m G is a supersolution, where G
/// bounds Green's function: the solution lies between. p is enclosed by Taylor series of (w M')' = w h, M(a)
/// = M'(a) = 0, on pieces so short that their remainders are below rounding (Moore, Kearfott and Cloud 2009,
/// section 9). None where h cannot be enclosed, and where without a given value there is no cavity that takes
/// m up.
std::optional<LineEnclosure> enclose_line(const EnclosedLineObstacle&, const LineSolution& found);

}  // namespace convex::inline obstacle_problem
