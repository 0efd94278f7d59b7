#pragma once

#include "convex/double_double.hpp"
#include "convex/gamma0/function.hpp"
#include "convex/gamma0/look.hpp"

namespace convex::linear_quadratic {
struct LinearQuadratic;
}
namespace convex::inline composite {
struct GraphForm;
}
namespace convex {
using linear_quadratic::LinearQuadratic;
}

namespace convex::inline gamma0 {

/// What a function is made of: the contract behind `Function`. Sizes have been checked at that door.
class FunctionNode : public std::enable_shared_from_this<FunctionNode> {
 public:
  virtual ~FunctionNode() = default;
  virtual Index dimension() const = 0;
  /// Throws InvalidInput when n entries cannot be: a matrix that is not square, fewer entries than are
  /// summed.
  virtual void require_size(Index) const {}
  virtual Facts facts() const = 0;
  virtual Call call() const = 0;
  virtual double value(const Vector& x) const = 0;
  /// The value with its error; some roundings of it unless the function knows better.
  virtual Value evaluate(const Vector& x) const;
  /// The same at a point of twice the precision, of an operation that passes it on to its functions; none
  /// where the value and the slopes at y.hi make it.
  virtual std::optional<Value> evaluate_pair(const DoubleDoubleVector& /*y*/) const { return std::nullopt; }
  /// `look`: how the programs in it are gone about.
  virtual Prox prox(const Vector& z, const Metric& W, const Look& look) const = 0;
  virtual Function conjugate() const = 0;
  virtual std::optional<Vector> subgradient(const Vector& x) const = 0;
  /// Of one entry: how far the slope at x, as `subgradient` gives it, may be from one at x. What moves x by d
  /// counts at most as the slope w d; 0 where there is no slope.
  virtual double error_of_slope(double x, double w) const;

  /// An upper bound of the recession function, f∞(d) = sup over x in the domain of f(x + d) - f(x)
  /// (Rockafellar 1970, section 8): f*(v) is +inf where f∞(d) < v·d. +inf where none is known.
  virtual double recession(const Vector& d) const;
  /// An upper bound of the support function of the domain, sup of v·x over the x with f(x) < inf, which is
  /// the recession function of f*: f(x) is +inf where v·x exceeds it. +inf where none is known.
  virtual double domain_support(const Vector& v) const;

  /// f_i of an f(x) = Σ_i f_i(x_i) + constant, a function of one entry; none where the f_i are not known.
  virtual std::optional<Function> entry(Index i) const;
  /// That constant; none where it is not known.
  virtual std::optional<Value> constant_beside_entries() const { return std::nullopt; }

  /// f on Rⁿ as a quadratic program over x and auxiliary variables; exactly when facts().piecewise_quadratic.
  /// It is what makes the prox exact in any metric.
  virtual std::optional<LinearQuadratic> linear_quadratic(Index n) const;
  /// f on Rⁿ as a sum of atoms of affine maps, minimised over auxiliary variables: what the iterative prox
  /// and every operation without a formula work on. None for a function known by value and prox alone.
  /// slope: of the size of a subgradient where the form is used, a power of 2; heights are measured in it.
  /// Less than 0: minus the size of the point, which is a slope of the functions that f has the conjugates
  /// of.
  virtual std::optional<GraphForm> graph(Index n, double slope = 1) const;
};

/// How far the slope of f, of one entry, at x may be from those within `moved` of x, as in `error_of_slope`.
double error_of_moved_slope(const FunctionNode& f, double x, double moved, double w);

}  // namespace convex::inline gamma0
