#pragma once

#include "convex/composite/jacobian.hpp"
#include "convex/gamma0/node.hpp"

namespace convex::inline composite {

/// ½ u·Qu + c·u + constant on Rⁿ. Q: n×n, symmetric positive semidefinite.
struct QuadraticForm {
  SparseMatrix Q;
  Vector c;
  double constant = 0;
};

/// A function whose prox in the identity metric, and in a diagonal one when it is separable, has a formula;
/// in any other metric its prox is found through `linear_quadratic` when there is one, else by the semismooth
/// Newton method on its graph form.
class Atom : public FunctionNode {
 public:
  /// argmin f(u) + ½ sum_i d_i (u_i - z_i)². d: n, positive; all entries equal unless
  /// takes_any_diagonal().
  virtual Vector prox_diagonal(const Vector& z, const Vector& d) const = 0;
  /// Does `prox_diagonal` take any positive d, and not just equal ones?
  virtual bool takes_any_diagonal() const { return facts().separable; }
  /// A subgradient of f at x = prox_diagonal(z, d) by a formula of its own: the one nearest to D(z - x),
  /// which is D(z - x) itself up to rounding. None where there is no such formula.
  virtual std::optional<Vector> prox_covector(const Vector& x, const Vector& z, const Vector& d) const;
  /// The same, made of the slopes of the functions that f is made of, where f is steep.
  virtual std::optional<Vector> steep_covector(const Vector& x, const Vector& z, const Vector& d) const;
  /// What x and v miss of "v is a subgradient at x", as a part of ||x - x*||_D, for formulas of which one is
  /// made from the other: their residual alone would compare a number with itself.
  virtual double subgradient_miss(const Vector& /*x*/, const Vector& /*v*/, const Vector& /*d*/) const {
    return 0;
  }
  /// Rows and columns together of the matrix whose singular values or eigenvalues `prox_diagonal` at n
  /// entries takes, 0 where it takes none: its rounding grows with them, and spreads over all entries.
  virtual Index decomposed_size(Index /*n*/) const { return 0; }
  /// Is `prox_diagonal` found from the prox of the conjugate?
  virtual bool prox_by_conjugate() const { return false; }
  /// The prox in a metric that is not diagonal by a method of the atom's own; none when it has none.
  virtual std::optional<Prox> prox_general(const Vector& z, const Metric& W) const;
  /// An element of the generalised Jacobian (Clarke 1983) of z -> prox_diagonal(z, d) at z: n×n,
  /// with D·J symmetric positive semidefinite.
  virtual Jacobian prox_jacobian(const Vector& z, const Vector& d) const = 0;

  /// The size of the data that bound the domain, 0 when none do: what membership is relative to besides the
  /// point.
  virtual double domain_size() const { return 0; }

  /// f on Rⁿ where it is quadratic or linear: sums of atoms then need no prox of it.
  virtual std::optional<QuadraticForm> quadratic_form(Index) const { return std::nullopt; }

  Prox prox(const Vector& z, const Metric& W, const Look& look) const override;
  std::optional<GraphForm> graph(Index n, double slope = 1) const override;
};

}  // namespace convex::inline composite
