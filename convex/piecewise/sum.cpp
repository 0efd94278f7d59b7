#include "convex/invalid_input.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/common_anchor.hpp"
#include "convex/piecewise/curve_builder.hpp"
#include "convex/piecewise/elementary.hpp"
#include "convex/piecewise/piece_cursor.hpp"

namespace convex::inline piecewise_quadratics {
namespace {

Segment added(const Segment& a, const Segment& b, double from, double to) {
  const double x = common_anchor(a, b, from, to);
  const double y_a = slope_at(a, x), y_b = slope_at(b, x);
  double run = 0, rise = 0;
  add_slopes(a, b, run, rise);
  return anchored(run, rise, x, y_a + y_b, value_at(a, x, y_a) + value_at(b, x, y_b));
}

PiecewiseQuadratic sum(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g, const char* where) {
  double x = 0;
  std::optional<PairOfCursors> both = PairOfCursors::meet(f, g, where, x);
  if (!both) return piecewise::point(x, f(x) + g(x));
  auto& [left, right, low, high] = *both;
  CurveBuilder curve(f.corners().size() + g.corners().size());
  const auto slope = [&](double at) { return left.slope(at) + right.slope(at); };
  const auto value = [&](double at) { return left.value(at) + right.value(at); };
  if (std::isfinite(low)) {
    curve.segment(vertical(low, value(low)));
    curve.corner(low, slope(low));
  }
  x = low;
  while (true) {
    const double end = both->end();
    curve.segment(added(left.piece(), right.piece(), x, end));
    if (end >= high) break;
    const double slope_before = slope(end), value_here = value(end);
    left.advance_to(end);
    right.advance_to(end);
    curve.joint(end, slope_before, slope(end), value_here);
    x = end;
  }
  if (std::isfinite(high)) {
    curve.corner(high, slope(high));
    curve.segment(vertical(high, value(high)));
  }
  return curve.finish(where);
}

}  // namespace

PiecewiseQuadratic sum(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g) { return sum(f, g, "sum"); }

PiecewiseQuadratic inf_convolution(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g) {
  const Interval first = slopes(f), second = slopes(g);
  if (first.high < second.low || second.high < first.low)
    throw InvalidInput("inf_convolution: it is -inf everywhere, for the slopes " + text(first) +
                       " of f and " + text(second) + " of g have none in common; tilt one of them");
  return conjugate(sum(conjugate(f), conjugate(g), "inf_convolution"));
}

}  // namespace convex::inline piecewise_quadratics
