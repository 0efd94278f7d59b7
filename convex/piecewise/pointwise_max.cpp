#include <algorithm>
#include <array>

#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/common_anchor.hpp"
#include "convex/piecewise/curve_builder.hpp"
#include "convex/piecewise/elementary.hpp"
#include "convex/piecewise/piece_cursor.hpp"

namespace convex::inline piecewise_quadratics {
namespace {

/// a b - c d to a rounding of the result or two (Kahan; Jeannerod, Louvet and Muller 2013).
double difference_of_products(double a, double b, double c, double d) {
  const double product = c * d, error = std::fma(-c, d, product);
  return std::fma(a, b, -product) + error;
}

/// f - g on an interval where both are one piece: h0 + h1 t + h2/2 t², t = x - origin.
struct Difference {
  double origin, h0, h1, h2;

  Difference(const Segment& f, const Segment& g, double from, double to)
      : origin(common_anchor(f, g, from, to)) {
    const double y_f = slope_at(f, origin), y_g = slope_at(g, origin);
    h0 = value_at(f, origin, y_f) - value_at(g, origin, y_g);
    h1 = y_f - y_g;
    h2 = equal_products(f.rise, g.run, g.rise, f.run) ? 0 : f.rise / f.run - g.rise / g.run;
  }

  /// The sign on an interval without a crossing.
  double sign(double from, double to) const {
    double x = origin;
    if (std::isfinite(from) && std::isfinite(to))
      x = from + (to - from) / 2;
    else if (std::isfinite(from))
      x = from + std::max(1.0, std::abs(from));
    else if (std::isfinite(to))
      x = to - std::max(1.0, std::abs(to));
    const double t = x - origin, h = h0 + t * (h1 + 0.5 * h2 * t);
    return h != 0 ? h : h2;  // a zero that is no crossing is a double root
  }

  /// The crossings inside (from, to), increasing; returns how many.
  std::size_t crossings(double from, double to, std::array<double, 2>& roots) const {
    std::array<double, 2> found{};
    std::size_t count = 0;
    if (h2 == 0) {
      if (h1 != 0) found[count++] = -h0 / h1;
    } else {
      const double discriminant = difference_of_products(h1, h1, 2 * h2, h0);
      if (discriminant <= 0) return 0;
      const double q = -(h1 + std::copysign(std::sqrt(discriminant), h1));
      found = {q / h2, 2 * h0 / q};
      count = 2;
    }
    std::size_t inside = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double x = origin + found[i];
      if (from < x && x < to) roots[inside++] = x;
    }
    if (inside == 2 && roots[0] > roots[1]) std::swap(roots[0], roots[1]);
    return inside;
  }
};

/// The curve of the maximum up to x, its next joint still open on the right.
struct OpenCurve {
  CurveBuilder curve;
  bool started = false;
  double x = 0, slope = 0, value = 0;

  /// Goes on along a piece from x.
  void follow(const PieceCursor& top, double from) {
    if (started)
      curve.joint(x, slope, top.slope(x), value);
    else if (std::isfinite(from)) {
      curve.segment(vertical(from, top.value(from)));
      curve.corner(from, top.slope(from));
    }
    started = true;
    curve.segment(top.piece());
  }
  void stop(const PieceCursor& top, double at) {
    x = at;
    slope = top.slope(at);
    value = top.value(at);
  }
};

}  // namespace

PiecewiseQuadratic pointwise_max(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g) {
  const char* where = "pointwise_max";
  double x = 0;
  std::optional<PairOfCursors> both = PairOfCursors::meet(f, g, where, x);
  if (!both) return piecewise::point(x, std::max(f(x), g(x)));
  OpenCurve open{CurveBuilder(2 * (f.corners().size() + g.corners().size()) + 2)};
  x = both->low;
  while (true) {
    const double end = both->end();
    const Difference difference(both->f.piece(), both->g.piece(), x, end);
    std::array<double, 2> roots{};
    const std::size_t count = difference.crossings(x, end, roots);
    for (std::size_t i = 0; i <= count; ++i) {
      const double to = i < count ? roots[i] : end;
      const PieceCursor& top = difference.sign(x, to) >= 0 ? both->f : both->g;
      open.follow(top, x);
      if (std::isfinite(to)) open.stop(top, to);
      x = to;
    }
    if (end >= both->high) break;
    both->f.advance_to(end);
    both->g.advance_to(end);
  }
  if (std::isfinite(both->high)) {
    open.curve.corner(open.x, open.slope);
    open.curve.segment(vertical(open.x, open.value));
  }
  return open.curve.finish(where);
}

}  // namespace convex::inline piecewise_quadratics
