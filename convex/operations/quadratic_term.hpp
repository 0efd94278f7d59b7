#pragma once

#include <optional>

#include "convex/gamma0/function.hpp"
#include "convex/operations/metric_algebra.hpp"

/// Quadratic functions among the terms of a sum or an inf-convolution, and what they do to the other terms.
namespace convex::inline operations {

/// ½ x·Qx + c·x + constant on n entries, Q: n×n symmetric positive semidefinite.
struct QuadraticTerm {
  SparseMatrix Q;
  Vector c;
  double constant = 0;
};

/// f on n entries as a quadratic term, when it is one.
std::optional<QuadraticTerm> quadratic_term(const Function& f, Index n);

/// mu when Q = mu I, mu >= 0.
std::optional<double> multiple_of_identity(const SparseMatrix& Q);

/// Qx + c + v, rounded once.
Vector slope_at(const QuadraticTerm& q, const Vector& x, const Vector& v);

/// The quadratic term as a function of the catalogue.
Function function_of(const QuadraticTerm& q);

/// q(b) = ½||b||_M²/gamma + c·b + constant with M definite: the kernel of a smoothing f □ q.
struct Kernel {
  Metric M;
  double gamma = 1;
  Vector c;
  double constant = 0;
  Metric Q = times(1 / gamma, M);  ///< M/gamma, as doubles have it: what is formed with it is corrected by M
};

/// None when Q is not positive definite to working precision.
std::optional<Kernel> kernel_of(const QuadraticTerm& q);

/// The w that attains (f □ q)(x) = min over w of f(w) + q(x - w), and the subgradient there, which is
/// Q(x - w) + c; empty, with a value of which nothing is known, where the prox of f gave up.
struct Smoothed {
  Vector w;
  Vector v;
  Value value;
  double off = 0;    ///< ||w - w*||_Q, and what the rounding of the point x + Q⁻¹c is in it
  double above = 0;  ///< the value at w is above the minimum by no more, in x as it is
};
Smoothed smoothed(const Function& f, const Kernel& q, const Vector& x);
/// That subgradient, if it is known.
std::optional<Vector> slope_of_smoothing(const Function& f, const Kernel& q, const Vector& x);

/// prox^W z of f □ q. With z = a + b + W⁻¹v, v in ∂f(a), v = Qb + c: a is the prox of f at z + Q⁻¹c in the
/// parallel sum of W and Q, and b = (W + Q)⁻¹(W(z - a) - c). What rounding leaves of r = W(x - z) + v and of
/// s = v - Qb - c is in the bound: ∂f is monotone, so that ||x - x*||_W² + ||b - b*||_Q² is at most
/// s·(b - b*) - r·(x - x*).
Prox smoothed_prox(const Function& f, const Kernel& q, const Vector& z, const Metric& W, const Look& look);

}  // namespace convex::inline operations
