#include "convex/piecewise/elementary.hpp"

#include <cmath>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/curve_builder.hpp"

namespace convex::inline piecewise_quadratics::piecewise {

PiecewiseQuadratic constant(double c) { return quadratic(0, 0, c); }

PiecewiseQuadratic linear(double c) { return quadratic(0, c, 0); }

PiecewiseQuadratic quadratic(double c2, double c1, double c0) {
  require(c2 >= 0 && std::isfinite(c2), "quadratic: not convex; give a finite factor of x^2/2, at least 0");
  require(std::isfinite(c1) && std::isfinite(c0), "quadratic: a coefficient is not finite; give numbers");
  CurveBuilder curve;
  curve.segment(anchored(1, c2, 0, c1, c0));
  return curve.finish("quadratic");
}

PiecewiseQuadratic point(double p, double c) {
  require(std::isfinite(p) && std::isfinite(c), "point: it must be finite, and its value too");
  CurveBuilder curve;
  curve.segment(vertical(p, c));
  return curve.finish("point");
}

PiecewiseQuadratic indicator(double low, double high) {
  require(low <= high, "box: empty; give lower <= upper");
  require(low < infinity && high > -infinity, "box: empty; an end is infinite on the wrong side");
  if (low == high) return point(low);
  CurveBuilder curve(2);
  if (std::isfinite(low)) {
    curve.segment(vertical(low, 0));
    curve.corner(low, 0);
  }
  curve.segment(Segment{});
  if (std::isfinite(high)) {
    curve.corner(high, 0);
    curve.segment(vertical(high, 0));
  }
  return curve.finish("box");
}

PiecewiseQuadratic support(double low, double high) { return conjugate(indicator(low, high)); }

PiecewiseQuadratic absolute(double weight) {
  require(weight >= 0 && std::isfinite(weight), "norm1: the weight must be finite and not negative");
  return support(-weight, weight);
}

PiecewiseQuadratic huber(double mu) {
  require(mu > 0 && std::isfinite(mu), "huber: mu must be positive and finite");
  return conjugate(add_square(indicator(-1, 1), mu));
}

PiecewiseQuadratic hinge() {
  // The conjugate of y on [-1, 0].
  return conjugate(tilt(indicator(-1, 0), 1));
}

PiecewiseQuadratic squared_hinge(double weight) {
  require(weight > 0 && std::isfinite(weight), "squared_hinge: the weight must be positive and finite");
  CurveBuilder curve(1);
  curve.segment(anchored(1, weight, 1, 0, 0));
  curve.corner(1, 0);
  curve.segment(Segment{});
  return curve.finish("squared_hinge");
}

PiecewiseQuadratic elastic_net(double l1, double l2) {
  require(l2 >= 0 && std::isfinite(l2), "elastic_net: l2 must be finite and not negative");
  require(l1 >= 0 && std::isfinite(l1), "elastic_net: l1 must be finite and not negative");
  return add_square(absolute(l1), l2);
}

}  // namespace convex::inline piecewise_quadratics::piecewise
