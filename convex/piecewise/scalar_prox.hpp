#pragma once

#include "convex/piecewise/piecewise_quadratic.hpp"
#include "convex/vector.hpp"

namespace convex::inline piecewise_quadratics {

/// A point x and a slope y of f at x: y in the subdifferential, each by the formula of its piece.
struct ProxPoint {
  double x = 0, y = 0;
};

/// argmin_u f(u) + d/2 (u - z)², d > 0 and finite, z finite (not checked): where the line y = d (z - u) meets
/// the curve. O(log n).
double prox(const PiecewiseQuadratic& f, double z, double d);
/// The same with y = d (z - x) computed on the curve, not by that difference: equal to it up to rounding.
ProxPoint prox_point(const PiecewiseQuadratic& f, double z, double d);
/// The derivative of prox(f, z, d) in z: an interval in [0, 1], one point but where z is at a corner of the
/// prox (its generalised Jacobian, Clarke 1983).
Interval prox_derivative(const PiecewiseQuadratic& f, double z, double d);

/// x_i = prox(f, z_i, d_i), all of one size; x may be z. Nothing is allocated.
void prox(const PiecewiseQuadratic& f, Eigen::Ref<const Vector> z, Eigen::Ref<const Vector> d,
          Eigen::Ref<Vector> x);
/// x_i = prox(f, z_i, d).
void prox(const PiecewiseQuadratic& f, Eigen::Ref<const Vector> z, double d, Eigen::Ref<Vector> x);

}  // namespace convex::inline piecewise_quadratics
