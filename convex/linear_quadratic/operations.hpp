#pragma once

#include <span>

#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/metric.hpp"

/// The algebra of piecewise linear-quadratic functions: each operation is a change of variables, a sum or a
/// new auxiliary variable, so that the result is again a program with the data of its parts (Rockafellar and
/// Wets 1998, exercise 10.22 and proposition 11.32). None of them looks whether the result is proper: see
/// properness.hpp. All throw InvalidInput when sizes do not fit.
namespace convex::linear_quadratic {

/// f + g + …
LinearQuadratic sum(std::span<const LinearQuadratic> terms);

/// (f □ g)(x) = min over y of f(x - y) + g(y), which is closed as it stands when it is proper (Rockafellar
/// and Wets 1998, proposition 11.32).
LinearQuadratic inf_convolution(const LinearQuadratic& f, const LinearQuadratic& g);

/// x -> f(Ax + b). A: f.n × n; b: f.n.
LinearQuadratic precompose(const LinearQuadratic& f, const SparseMatrix& A, const Vector& b);

/// max(f, g, …) for functions that differ by polyhedral ones: each is q + a polyhedral function, with one and
/// the same quadratic q of x. The maximum of others is not piecewise linear-quadratic, and refused.
LinearQuadratic pointwise_max(std::span<const LinearQuadratic> terms);

/// alpha f, alpha > 0.
LinearQuadratic scale(const LinearQuadratic& f, double alpha);

/// x -> f(x / rho), rho not 0.
LinearQuadratic dilate(const LinearQuadratic& f, double rho);

/// x -> f(x - by).
LinearQuadratic translate(const LinearQuadratic& f, const Vector& by);

/// x -> f(x) + v·x.
LinearQuadratic tilt(const LinearQuadratic& f, const Vector& v);

/// f + constant.
LinearQuadratic raise(const LinearQuadratic& f, double constant);

/// (x_1, x_2, …) -> f_1(x_1) + f_2(x_2) + …
LinearQuadratic separable(std::span<const LinearQuadratic> blocks);

/// Moreau's envelope, min over y of f(y) + ||x - y||_W² / (2 gamma) (Moreau 1965), gamma > 0.
LinearQuadratic envelope(const LinearQuadratic& f, double gamma, const Metric& W);

/// The proximal average with weight t on f and parameter gamma, the function whose envelope is the mean of
/// envelopes (Bauschke, Goebel, Lucet and Wang 2008, definition 4.1); with y_1 = x + (1-t) d, y_2 = x - t d
/// their formula reads
///   min over d of t f(x + (1-t) d) + (1-t) g(x - t d) + t (1-t) ||d||_W² / (2 gamma).
/// 0 <= t <= 1, gamma > 0.
LinearQuadratic proximal_average(const LinearQuadratic& f, const LinearQuadratic& g, double t, double gamma,
                                 const Metric& W);

/// f*(v) = sup_x v·x - f(x), the dual program (Dorn 1960; Rockafellar and Wets 1998, example 11.43 and
/// theorem 11.14):
///   f*(v) = min over lambda, eta of ½ eta·H eta - h·lambda - constant,  H eta - Gᵀlambda = (v, 0) - c,
/// lambda >= 0 on one-sided rows. It is improper when f is.
LinearQuadratic conjugate(const LinearQuadratic& f);

/// The recession function f∞(d) = sup over x of f(x + d) - f(x): min over w of c·(d, w) with G (d, w) >= 0
/// and H (d, w) = 0 (Rockafellar 1970, section 8).
LinearQuadratic recession(const LinearQuadratic& f);

/// The conjugate in the product of W, g(y) = sup_x (x|y) - f(x) = f*(Wy).
LinearQuadratic conjugate(const LinearQuadratic& f, const Metric& W);

}  // namespace convex::linear_quadratic
