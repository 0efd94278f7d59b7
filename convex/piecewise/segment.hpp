#pragma once

#include <cmath>
#include <limits>

namespace convex::inline piecewise_quadratics {

/// A line in the plane of points x and slopes y, and the values on it of the function f whose derivative it
/// is and of its conjugate g: rise (x - x_0) = run (y - y_0) through an anchor (x_0, y_0) with f(x_0) = f and
/// g(y_0) = g, f + g = x_0 y_0. run, rise >= 0, not both 0. The slope is kept as a pair and the line goes
/// through an anchor of its own, not through a corner, so that conjugation is a swap without rounding and
/// coefficients are read back as they were given.
struct Segment {
  double run = 1, rise = 0;
  double x = 0, y = 0;
  double f = 0, g = 0;
};

/// The segment with g = x y - f.
inline Segment anchored(double run, double rise, double x, double y, double f) {
  return {run, rise, x, y, f, std::fma(x, y, -f)};
}

/// x = p, all slopes: where f has a kink or its domain ends. Anchored at slope 0, so that the conjugate's
/// piece p y - f has its coefficients without rounding.
inline Segment vertical(double p, double f) { return {0, 1, p, 0, f, 0 - f}; }

/// y on the line above x; run > 0.
inline double slope_at(const Segment& line, double x) {
  return line.rise == 0 ? line.y : line.y + line.rise * (x - line.x) / line.run;
}

/// f(x), given the slope y at x: the trapezoid under the line. A slope that is known better than the line's
/// own, as at a corner, makes the value better.
inline double value_at(const Segment& line, double x, double y) {
  return line.f + 0.5 * (line.y + y) * (x - line.x);
}

inline Segment conjugate(const Segment& line) {
  return {line.rise, line.run, line.y, line.x, line.g, line.f};
}

/// Whether a b = c d exactly.
inline bool equal_products(double a, double b, double c, double d) {
  const double first = a * b;
  return first == c * d && std::fma(a, b, -first) == std::fma(c, d, -first);
}

/// Whether the second line is the first one, to the last digit of what is computed at its anchor.
inline bool same_line(const Segment& first, const Segment& second) {
  if (!equal_products(first.rise, second.run, second.rise, first.run)) return false;
  const bool flat = first.run >= first.rise;
  const Segment line = flat ? first : conjugate(first), other = flat ? second : conjugate(second);
  const double y = slope_at(line, other.x);
  return y == other.y && value_at(line, other.x, y) == other.f;
}

/// The direction of a sum of slopes: rise/run = a.rise/a.run + b.rise/b.run, without a division where the
/// numbers allow it.
inline void add_slopes(const Segment& a, const Segment& b, double& run, double& rise) {
  const double product = a.run * b.run, cross = a.rise * b.run + b.rise * a.run;
  constexpr double least = 0x1p-500, most = 0x1p+500;
  if (a.run == b.run) {
    run = a.run;
    rise = a.rise + b.rise;
  } else if (a.rise == 0 || b.rise == 0) {
    run = a.rise == 0 ? b.run : a.run;
    rise = a.rise == 0 ? b.rise : a.rise;
  } else if (product > least && product < most && cross > least && cross < most) {
    run = product;
    rise = cross;
  } else {
    const double larger = std::fmax(a.run, b.run), smaller = std::fmin(a.run, b.run);
    run = smaller;
    rise = a.run < b.run ? a.rise + b.rise * (smaller / larger) : b.rise + a.rise * (smaller / larger);
  }
}

}  // namespace convex::inline piecewise_quadratics
