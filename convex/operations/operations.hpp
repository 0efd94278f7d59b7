#pragma once

#include <span>

#include "convex/gamma0/function.hpp"

/// The operations of docs/functions.md on functions of Gamma_0. Where no formula and no exact reduction gives
/// value, prox or conjugate, they are found through the parts as programs: `LinearQuadratic` when all parts
/// are piecewise linear-quadratic, else `GraphForm`. Products, norms and conjugates are plain unless a metric
/// is given. Sizes that do not fit, and results that are not convex, closed and proper, are InvalidInput;
/// whether a result is proper depends on n, and is looked at when n is known from the parts or given.
///
/// Each `conjugate()` is a rule on the expression: f** gives f back to the rounding of the numbers in it.
namespace convex::inline operations {

/// x -> f(x - by). prox^W z = by + prox^W_f(z - by); (f(· - by))* = f* + by·.
Function translate(const Function& f, const Vector& by);

/// f + c·x. prox^W z = prox^W_f(z - W⁻¹c); its conjugate is f*(· - c).
Function tilt(const Function& f, const Vector& c);

/// alpha f, alpha > 0. Its prox in W is that of f in W/alpha; its conjugate is alpha f*(·/alpha).
Function scale(const Function& f, double alpha);

/// x -> f(x/rho), rho not 0. prox^W z = rho prox_f(z/rho) in rho² W; its conjugate is f*(rho ·).
Function dilate(const Function& f, double rho);

/// f_1 + f_2 + …; throws InvalidInput when no point has all of them finite. Quadratic terms go to the metric:
/// with ½ x·Qx + c·x among them the prox is that of the rest at (W + Q)⁻¹(Wz - c) in W + Q. The conjugate is
/// the inf-convolution of the conjugates, closed (Rockafellar 1970, Theorem 16.4).
Function sum(std::span<const Function> terms, Index n = 0);

/// The closure of x -> inf over w of f(w) + g(x - w); throws InvalidInput when it is -inf everywhere. When g
/// is a definite quadratic the prox of f in the parallel sum of W and Q gives that of f □ g. Its conjugate is
/// f* + g* (Rockafellar 1970, Theorem 16.4).
Function inf_convolution(const Function& f, const Function& g, Index n = 0);

/// Moreau's envelope min over w of f(w) + ||x - w||_M² / (2 gamma), gamma > 0, M = I unless given (Moreau
/// 1965). Its conjugate is f* + gamma/2 ||·||²_(M⁻¹).
Function envelope(const Function& f, double gamma);
Function envelope(const Function& f, double gamma, const Metric& M);

/// x -> f(Ax + b); throws InvalidInput when Ax + b never meets the domain of f. A: m×n; b: m. When the rows
/// of A are independent, the prox is W⁻¹Aᵀ away from that of f at Az + b in (A W⁻¹Aᵀ)⁻¹, which is diagonal
/// when A W⁻¹Aᵀ is (nu I: Combettes and Pesquet 2007, Proposition 11). The conjugate is a rule when they are
/// independent, else computed.
Function precompose(const Function& f, const Matrix& A, const Vector& b);

/// f_1(x_1) + f_2(x_2) + … over consecutive blocks of so many entries. The prox goes block by block in a
/// metric that does not couple the blocks.
Function separable(std::span<const Function> parts, const std::vector<Index>& sizes);

/// x -> max_i f_i(x); throws InvalidInput when no point has all of them finite.
Function pointwise_max(std::span<const Function> parts, Index n = 0);

/// The proximal average (Bauschke, Goebel, Lucet and Wang 2008) with weight t in (0, 1) on f, gamma > 0:
///   inf {t f(p) + (1-t) g(q) + t (1-t)/(2 gamma) ||p - q||_M² : t p + (1-t) q = x}.
/// Its prox in M/gamma is the mean of the proxes; its conjugate the average of f* and g* with 1/gamma and
/// M⁻¹.
Function proximal_average(const Function& f, const Function& g, double t, double gamma);
Function proximal_average(const Function& f, const Function& g, double t, double gamma, const Metric& M);

/// (x, s) -> s f(x/s) for s > 0, its closure at s = 0 (the recession function), +inf for s < 0; s is the last
/// entry. Its conjugate is the indicator of {(v, r) : f*(v) <= -r} (Rockafellar 1970, Corollary 13.5.1).
Function perspective(const Function& f);

/// The indicator of {(x, t) : f(x) <= t}, t the last entry.
Function epigraph(const Function& f);

/// The indicator of the intersection; throws InvalidInput when it is empty.
Function intersection(std::span<const Set> sets, Index n = 0);

/// weight times the plain distance of x to the set, weight > 0.
Function distance(const Set& set, double weight = 1);

/// weight/2 times the square of the plain distance of x to the set, weight > 0.
Function squared_distance(const Set& set, double weight = 1);

/// f*(v) = sup_x v·x - f(x) by its value and prox alone: the value through the program of f, the prox by
/// Moreau's identity prox^W_{f*} z = z - W⁻¹ prox_f(Wz) in W⁻¹. For functions whose conjugate has no
/// expression.
Function computed_conjugate(const Function& f);

/// The prox of f by the program of f itself, never by a formula or from its conjugate: a second route beside
/// `Function::prox`. None for functions without a program.
std::optional<Prox> prox_by_program(const Function& f, const Vector& z, const Metric& W,
                                    const Look& look = {});

/// h(Mx), M the Gram matrix of a metric: with h = f* the conjugate of f in the product (x|y) = x·My.
Function in_product(const Function& h, const Metric& M);

/// Throws InvalidInput "where: …" when f, on n entries, is +inf everywhere. True is assumed where neither
/// program is at hand.
void require_proper(const Function& f, Index n, const char* where);

}  // namespace convex::inline operations
