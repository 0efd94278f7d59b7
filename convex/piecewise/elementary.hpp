#pragma once

#include "convex/piecewise/piecewise_quadratic.hpp"

/// The functions of one variable that others are made of. Each throws InvalidInput on a parameter outside its
/// range.
namespace convex::inline piecewise_quadratics::piecewise {

/// c.
PiecewiseQuadratic constant(double c);
/// cx.
PiecewiseQuadratic linear(double c);
/// c2/2 x² + c1 x + c0, c2 >= 0.
PiecewiseQuadratic quadratic(double c2, double c1 = 0, double c0 = 0);
/// c at p, +inf elsewhere.
PiecewiseQuadratic point(double p, double c = 0);
/// 0 on [low, high], +inf elsewhere; the ends may be infinite or equal.
PiecewiseQuadratic indicator(double low, double high);
/// The support function of [low, high]: low x for x < 0, high x for x > 0; the ends may be infinite or equal.
PiecewiseQuadratic support(double low, double high);
/// weight |x|, weight >= 0.
PiecewiseQuadratic absolute(double weight = 1);
/// x²/(2mu) for |x| <= mu, else |x| - mu/2; mu > 0.
PiecewiseQuadratic huber(double mu);
/// max(0, 1 - x).
PiecewiseQuadratic hinge();
/// weight/2 max(0, 1 - x)², weight > 0.
PiecewiseQuadratic squared_hinge(double weight = 1);
/// l1 |x| + l2/2 x², l1, l2 >= 0.
PiecewiseQuadratic elastic_net(double l1, double l2);

}  // namespace convex::inline piecewise_quadratics::piecewise
