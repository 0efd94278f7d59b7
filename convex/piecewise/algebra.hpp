#pragma once

#include "convex/piecewise/piecewise_quadratic.hpp"

/// The closed algebra of piecewise linear-quadratic functions of one variable. Every operation is exact on
/// the breakpoints but for the rounding of each number, takes time linear in the pieces, and throws
/// InvalidInput when its result is not convex, closed and proper or overflows.
namespace convex::inline piecewise_quadratics {

/// f*(y) = sup_x xy - f(x): the rows of the curve swapped, so conjugate(conjugate(f)) is f, byte for byte.
PiecewiseQuadratic conjugate(PiecewiseQuadratic f);

/// inf_u f(u) + (x - u)²/(2 gamma), gamma > 0 (Moreau 1965): the shear x -> x + gamma y of the curve.
PiecewiseQuadratic envelope(const PiecewiseQuadratic& f, double gamma);
/// f(x) + c/2 x², c >= 0: the shear y -> y + c x.
PiecewiseQuadratic add_square(const PiecewiseQuadratic& f, double c);

/// alpha f, alpha > 0.
PiecewiseQuadratic scale(const PiecewiseQuadratic& f, double alpha);
/// f(x/rho), rho not 0, of either sign.
PiecewiseQuadratic dilate(const PiecewiseQuadratic& f, double rho);
/// f(x - by).
PiecewiseQuadratic translate(const PiecewiseQuadratic& f, double by);
/// f(x) + cx.
PiecewiseQuadratic tilt(const PiecewiseQuadratic& f, double c);
/// f(x) + c.
PiecewiseQuadratic add_constant(const PiecewiseQuadratic& f, double c);

/// f + g. The domains must meet.
PiecewiseQuadratic sum(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g);
/// max(f, g). The domains must meet. New breakpoints are roots, right to a few roundings of the pieces that
/// cross (exact where the root and its discriminant are).
PiecewiseQuadratic pointwise_max(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g);
/// inf_u f(u) + g(x - u) = (f* + g*)*, closed. Refused when it is identically -inf: no slope is common.
PiecewiseQuadratic inf_convolution(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g);
/// The p with envelope(p, gamma) = weight envelope(f, gamma) + (1 - weight) envelope(g, gamma), gamma > 0,
/// 0 <= weight <= 1 (Bauschke, Goebel, Lucet and Wang 2008): its prox is the average of theirs.
PiecewiseQuadratic proximal_average(const PiecewiseQuadratic& f, const PiecewiseQuadratic& g, double weight,
                                    double gamma);

}  // namespace convex::inline piecewise_quadratics
