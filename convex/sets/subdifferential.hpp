#pragma once

#include <optional>
#include <string>

#include "convex/exact_program/exact_gram.hpp"
#include "convex/sets/exact_polyhedron.hpp"

namespace convex::inline sets {

/// ∂f(x) = {v : f(u) >= f(x) + v·(u - x) for all u} (Moreau 1963; Rockafellar 1970, section 23), covectors in
/// the plain product; empty where f(x) = +inf, and where f has a vertical slope. Of an indicator it is the
/// normal cone. x = prox_f z in the metric W exactly when W(z - x) is in it.
///
/// Piecewise linear-quadratic f, and those plus differentiable ones, give a polyhedron: the rows that x
/// touches are found in fractions, without a tolerance, so that x = 1/3 touches a bound of 1/3 and its double
/// does not. A gradient that is not rational is rounded, as `is_exact` says.
struct Subdifferential {
  std::size_t n = 0;
  std::optional<ExactPolyhedron> polyhedron;  ///< where it is one
  std::optional<Set> set;                     ///< none when empty
  bool is_exact = false;
  /// Of a set that is no polyhedron: d -> f'(x; d), as an expression of the language in the plain product,
  /// and whether the set is bounded.
  std::optional<Call> support_function;
  bool is_bounded_set = false;

  bool is_empty() const { return !set; }
  bool is_single() const { return polyhedron && polyhedron->is_point(); }
  /// Is v a subgradient at x? Of a polyhedron in fractions, else up to `membership_tolerance`.
  bool contains(const Fractions& v) const;
  /// f'(x; d) = sup of d·v over the set, the one-sided directional derivative where f is finite around x
  /// (Rockafellar 1970, theorem 23.4); +inf allowed. Not of an empty set.
  double support(const Fractions& d) const;
  /// The nearest point to a covector u in the norm ||·||_(V), the element of least norm for u = 0. Not of an
  /// empty set.
  Vector projection(const Vector& u, const Metric& V) const;
};

/// By the calculus of Rockafellar (1970, section 23) from the parts that f is made of, where its conditions
/// are met: of a sum, all parts are polyhedral, all but one finite around x, or their domains do not touch
/// there; of f(Ax + b), f is finite around Ax + b, or A is onto. Throws InvalidInput where they are not, or
/// no rule gives the set (docs/subdifferentials.md lists the rules).
Subdifferential subdifferential(const Call& f, const ExactGram& W, const Fractions& x);

/// The tangent cone of C at x, {d : a·d <= 0 for all normals a}, polar to the normal cone; the critical cone
/// for a normal v there, {d tangent : v·d = 0}. Of polyhedra: `normal` is ∂ of the indicator of C at x.
/// Throws InvalidInput when it is empty or no polyhedron, or v is not in it.
PolyhedralCone tangent_cone(const Subdifferential& normal);
PolyhedralCone critical_cone(const Subdifferential& normal, const Fractions& v);

/// The one-sided directional derivative of z -> prox_f z, h = lim (prox_f(z + t d) - prox_f z)/t for t > 0,
/// of a piecewise linear-quadratic f, in fractions. It is itself a prox: h minimises
///   ½||h - d||_W² + ½ η·Hη  over η = (h, w) in the critical cone
/// of the rows that touch, those with a multiplier as equations (Rockafellar and Wets 1998, exercise 13.24
/// and proposition 12.49). Multipliers need not be unique. Throws InvalidInput for another f.
Fractions prox_derivative(const Call& f, const ExactGram& W, const Fractions& z, const Fractions& d);

/// An element of Clarke's generalised Jacobian of z -> prox_f z (Clarke 1983) where the prox has a formula:
/// n×n, W J symmetric positive semidefinite. W: identity, or diagonal where the formula takes it. Throws
/// InvalidInput for another f or W.
Matrix prox_jacobian(const Function& f, const Vector& z, const Metric& W);

}  // namespace convex::inline sets
