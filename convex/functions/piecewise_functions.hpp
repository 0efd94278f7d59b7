#pragma once

#include "convex/gamma0/function.hpp"

/// Piecewise linear-quadratic functions of each entry by itself, and linear ones. Their conjugates are of the
/// same kind. InvalidInput on a parameter that is not finite or outside its range.
namespace convex::inline named_functions {

/// 0. Conjugate: the indicator of {0}.
Function zero();
/// c, whatever x. Conjugate: the indicator of {0}, minus c.
Function constant(double c);
/// c·x. Conjugate: the indicator of {c}.
Function linear(const Vector& c);
/// weight Σ|x_i|, or Σ weight_i |x_i|; weight >= 0. Conjugate: the indicator of |v_i| <= weight.
Function norm1(double weight = 1);
Function norm1(const Vector& weight);
/// weight/2 |x|₂², weight >= 0. Conjugate: squared_norm2(1/weight).
Function squared_norm2(double weight = 1);
/// Σ x²/(2mu) for |x| <= mu, else |x| - mu/2; mu > 0 (Huber 1964). Conjugate: mu/2 |v|² on |v_i| <= 1.
Function huber(double mu = 1);
/// Σ max(0, 1 - x). Conjugate: Σ v on -1 <= v <= 0.
Function hinge();
/// Σ max(0, 1 - x)². Conjugate: Σ v²/4 + v on v <= 0.
Function squared_hinge();
/// l1 |x|₁ + l2/2 |x|₂², l1, l2 >= 0 (Zou and Hastie 2005). Conjugate: Σ max(0, |v| - l1)²/(2 l2).
Function elastic_net(double l1 = 1, double l2 = 1);
/// Σ max(tau x, (tau - 1) x), 0 <= tau <= 1 (Koenker and Bassett 1978). Conjugate: the indicator of tau - 1
/// <= v
/// <= tau.
Function pinball(double tau = 0.5);
/// Σ p(x_i): p is c2/2 x² + c1 x + c0 between k increasing breaks, a row [c2, c1, c0] a piece; [inf, 0, 0] is
/// +inf there. p has to be convex, continuous where finite and finite somewhere.
Function plq(const Vector& breaks, const Matrix& coefficients);

}  // namespace convex::inline named_functions
