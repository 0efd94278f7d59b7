#pragma once

#include "convex/vector.hpp"

/// Piecewise linear-quadratic functions of each entry by itself: one pass, no branches. A step t is the
/// weight of the function; in a diagonal metric d it is a vector, weight / d_i. t >= 0; vectors have the size
/// of z (InvalidInput otherwise).
namespace convex::prox_formulas {

/// Prox of t|u|: z - clamp(z, -t, t).
Vector prox_norm1(const Vector& z, double t);
Vector prox_norm1(const Vector& z, const Vector& t);
Vector prox_norm1_slope(const Vector& z, const Vector& t);

/// Nearest point with lower <= x <= upper; bounds may be infinite. In every diagonal metric.
Vector proj_box(const Vector& z, double lower, double upper);
Vector proj_box(const Vector& z, const Vector& lower, const Vector& upper);
Vector proj_box_slope(const Vector& z, const Vector& lower, const Vector& upper);

/// Prox of t h(u), h(u) = u²/(2mu) for |u| <= mu, else |u| - mu/2 (Huber 1964), mu >= 0.
Vector prox_huber(const Vector& z, double mu, double t);
Vector prox_huber(const Vector& z, double mu, const Vector& t);
Vector prox_huber_slope(const Vector& z, double mu, const Vector& t);

/// Prox of t max(0, 1 - u).
Vector prox_hinge(const Vector& z, double t);
Vector prox_hinge(const Vector& z, const Vector& t);
Vector prox_hinge_slope(const Vector& z, const Vector& t);

/// Prox of t/2 max(0, 1 - u)².
Vector prox_squared_hinge(const Vector& z, double t);
Vector prox_squared_hinge(const Vector& z, const Vector& t);
Vector prox_squared_hinge_slope(const Vector& z, const Vector& t);

/// Prox of t1 |u| + t2/2 u².
Vector prox_elastic_net(const Vector& z, double t1, double t2);
Vector prox_elastic_net(const Vector& z, const Vector& t1, const Vector& t2);
Vector prox_elastic_net_slope(const Vector& z, const Vector& t1, const Vector& t2);

}  // namespace convex::prox_formulas
