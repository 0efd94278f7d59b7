#pragma once

#include <functional>
#include <memory>

#include "convex/composite/atom.hpp"

namespace convex::inline named_functions {

/// How `project` and `support_prox` split a point between them: each by its own formula, or one of them from
/// what the other found.
enum class SplitRoute { two_formulas, support_prox_from_projection, projection_from_support_prox };

/// A closed convex set S, not empty, by what algorithms know of it: its projection and its support function.
/// `indicator_of` and `support_of` make the two conjugate functions of it; every norm, max and sum_largest is
/// the support function of such a set, so that each pair has one algorithm. d is n positive numbers, all
/// equal unless `takes_any_diagonal()`.
class ConvexSet : public std::enable_shared_from_this<ConvexSet> {
 public:
  virtual ~ConvexSet() = default;
  virtual Index dimension() const = 0;
  /// Throws InvalidInput "name: …" when the set, or its support function, of that name has no n entries.
  virtual void require_size(Index, const std::string&) const {}
  /// The set in the language, such as box(lower=0, upper=1).
  virtual Call call() const = 0;
  /// Its support function in the language; support(call()) unless it has a name of its own.
  virtual Call support_call() const;
  /// Facts of the indicator; `indicator` itself is understood.
  virtual Facts facts() const = 0;
  /// Facts of the support function beside those that follow from `facts()`; finite when S is bounded.
  virtual bool bounded() const = 0;
  /// Is S the base polytope of a submodular function, so that its support function is a Lovász extension?
  virtual bool is_base_polytope() const { return false; }
  /// Does S go on without end along d, which is not 0? Not known counts as no.
  virtual bool recedes(const Vector& d) const { return facts().cone && contains(d); }
  /// The size of the data, against which `membership_tolerance` is measured beside |x|; 0 for a cone.
  virtual double scale() const { return 0; }

  virtual bool takes_any_diagonal() const { return facts().separable; }
  /// argmin sum_i d_i (u_i - z_i)² over S.
  virtual Vector project(const Vector& z, const Vector& d) const = 0;
  /// An element of the generalised Jacobian of z -> project(z, d).
  virtual Jacobian project_jacobian(const Vector& z, const Vector& d) const = 0;
  /// The indicator at x, with the tolerances relative to |x| + scale(). The distance to the projection
  /// decides.
  virtual Value membership(const Vector& x) const;
  bool contains(const Vector& x) const { return membership(x).value == 0; }

  /// sup over s in S of s·v; +inf when v, up to `membership_tolerance`, has none.
  virtual double support(const Vector& v) const = 0;
  /// The same with its rounding, and with the doubt where the tolerance decides.
  virtual Value support_value(const Vector& v) const;
  /// One s in S with s·v = support(v); none when there is none.
  virtual std::optional<Vector> maximiser(const Vector& v) const = 0;
  /// The prox of the support function, by a formula of its own and not from `project`; see `SplitRoute`.
  virtual Vector support_prox(const Vector& z, const Vector& d) const = 0;
  /// As Atom::decomposed_size, of the projection and of the prox of the support function.
  virtual Index decomposed_size(Index /*n*/) const { return 0; }
  virtual SplitRoute split_route() const { return SplitRoute::two_formulas; }
  /// Moves s or u, of a set whose split has one route, so that s is in S and u normal to S there: how far
  /// they have to move is what the formula did not keep.
  virtual void make_conjugate(Vector& /*s*/, Vector& /*u*/) const {}

  /// The projection in a general metric, by a method of the set's own.
  virtual std::optional<Prox> project_general(const Vector&, const Metric&) const { return std::nullopt; }
  /// The indicator and the support function as programs, exactly when facts().piecewise_quadratic.
  virtual std::optional<LinearQuadratic> indicator_form(Index n) const;
  virtual std::optional<LinearQuadratic> support_form(Index n) const;
};

/// The indicator of S: 0 on S, +inf elsewhere.
Function indicator_of(std::shared_ptr<const ConvexSet> S);
/// The plain support function of S, sup over s in S of s·v.
Function support_of(std::shared_ptr<const ConvexSet> S);
/// S under its own name.
Set set_of(std::shared_ptr<const ConvexSet> S);

/// A closed convex cone by its algorithms. Its support function is the indicator of its polar, {v : the
/// projection of v is 0}.
struct Cone {
  Call call;
  Call polar_call;      ///< the indicator of the polar
  Index dimension = 0;  ///< 0: any number of entries
  std::function<Vector(const Vector& z, const Vector& d)> project;
  std::function<Matrix(const Vector& z, const Vector& d)> jacobian;
  /// The projection on the polar in D, a multiple of the identity unless any_diagonal.
  std::function<Vector(const Vector& z, const Vector& d)> project_polar;
  std::function<void(Index n, const std::string& name)> require_size = {};
  std::function<LinearQuadratic(Index n)> form = {};
  bool any_diagonal = false;
  SplitRoute route = SplitRoute::two_formulas;
  bool of_eigenvalues = false;  ///< of a square matrix
  /// As ConvexSet::make_conjugate.
  std::function<void(Vector& s, Vector& u)> make_conjugate = {};
};
Set set_of(Cone K);

}  // namespace convex::inline named_functions
