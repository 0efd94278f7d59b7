#pragma once

#include <concepts>
#include <memory>
#include <optional>

#include "convex/gamma0/call.hpp"
#include "convex/gamma0/facts.hpp"
#include "convex/gamma0/look.hpp"
#include "convex/gamma0/prox.hpp"
#include "convex/metric.hpp"

namespace convex::inline gamma0 {

class FunctionNode;

/// What the laws ask of a function that a user writes: a value with two verbs, f(x) and f.prox(z, W).
template <class F>
concept Gamma0 = requires(const F& f, const Vector& x, const Metric& W) {
  { f(x) } -> std::convertible_to<double>;
  { f.prox(x, W) } -> std::convertible_to<Vector>;
};

/// A convex, closed, proper function f : Rⁿ -> (-inf, +inf], chosen at run time. Immutable; copies share it.
/// Covectors are plain: the subdifferential and `conjugate()` use v·x, whatever the metric of a prox. The
/// conjugate in the product (x|y) = x·Wy is `conjugate(W)`: g(y) = f*(Wy).
class Function {
 public:
  explicit Function(std::shared_ptr<const FunctionNode> node) : node_(std::move(node)) {}

  /// The number of entries of x; 0 when any number will do (norm1, zero, …).
  Index dimension() const;
  Facts facts() const;
  /// The expression that makes this function again, in the language of docs/functions.md.
  Call call() const;

  /// f(x), +inf outside the domain (up to `membership_tolerance`). Throws InvalidInput when the size is
  /// wrong.
  double operator()(const Vector& x) const;
  /// The same with what is known of its error.
  Value evaluate(const Vector& x) const;

  /// argmin ½||u - z||_W² + f(u) (Moreau 1965); a step is a metric: W/gamma gives the prox of gamma f.
  /// `look` says how programs are gone about, where there is no formula.
  Prox prox(const Vector& z, const Metric& W, const Look& look = {}) const;

  /// f*(v) = sup_x v·x - f(x) (Fenchel 1949), as an expression by rule where a rule exists, else as a
  /// function whose value and prox are computed.
  Function conjugate() const;
  /// The conjugate in the metric's product: g(y) = sup_x (x|y) - f(x) = f*(Wy).
  Function conjugate(const Metric& W) const;

  /// One v with f(u) >= f(x) + v·(u - x) for all u; none where the subdifferential is empty.
  std::optional<Vector> subgradient(const Vector& x) const;
  /// Is v a subgradient of f at x? Exactly when prox_f(x + v) = x in the plain metric; up to
  /// `membership_tolerance`.
  bool is_subgradient(const Vector& v, const Vector& x) const;

  const FunctionNode& node() const { return *node_; }
  std::shared_ptr<const FunctionNode> shared() const { return node_; }

 private:
  std::shared_ptr<const FunctionNode> node_;
};

/// A closed convex set: its indicator, and the call that names it (`box(…)`, not `indicator(box(…))`).
struct Set {
  Function indicator;
  Call call;
};

}  // namespace convex::inline gamma0
