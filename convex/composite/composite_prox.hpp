#pragma once

#include <optional>

#include "convex/composite/graph_form.hpp"

namespace convex::inline composite {

/// prox_f z = argmin ½||x - z||_W² + f(x) of a graph form in any metric, to 1e-12 (||z||_W + ||x||_W) in
/// metrics of condition 1e6; `status` is `inaccurate` where the bound says less, `infeasible` where no (x, w)
/// has finite terms. z: n; W: n×n; throws InvalidInput when sizes differ.
///
/// Method: the proximal method of multipliers (Rockafellar 1976) with semismooth Newton steps inside (Li, Sun
/// and Toh 2018), which converges from anywhere as its inner problems are strongly convex; between its steps
/// Newton's method on the optimality conditions is tried, and kept as long as it divides their residual.
///
/// v is the sum of M_xᵀy over the terms, y_j a subgradient of scale_j f_j at u_j, the prox of the term.
/// When M is made of unit rows, x is put together from the u_j, v is a subgradient of f at x, and the error
/// bound is ||W(x - z) + v||_(W⁻¹) (firm nonexpansiveness) and the rounding of x and v: proven, as far as the
/// atoms' own proxes are right to a few roundings. Otherwise M ξ + b misses u by some r, and
///   ||x - x*||_W² <= ||rho||_(W⁻¹) ||x - x*||_W + |r·(y - y*)| + |rho_w·(w - w*)|
/// is used with y - y*, w - w* *estimated* by a Newton step: an estimate, with a safety factor.
Prox prox(const GraphForm& f, const Vector& z, const Metric& W, const Look& look = {});

/// f(x) = constant + min over w, with what proves it.
struct GraphValue {
  double value = 0;         ///< +inf where x misses the domain by more than `membership_tolerance`
  Vector w;                 ///< a minimiser: k; empty when the value is +inf
  std::optional<Vector> v;  ///< a subgradient of f at x, where the multipliers exist
  double error_bound = 0;   ///< an estimate of the error of `value`
  Status status = Status::solved;
};

/// The value and its error, as functions have it.
Value value_of(const GraphValue& found);

/// The value of a graph form at x (n). A graph form of an improper function may be -inf.
GraphValue evaluate(const GraphForm& f, const Vector& x);

}  // namespace convex::inline composite
