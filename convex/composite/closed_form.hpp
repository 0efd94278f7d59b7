#pragma once

#include "convex/gamma0/facts.hpp"
#include "convex/gamma0/prox.hpp"
#include "convex/metric.hpp"

namespace convex::inline composite {

/// What rounding x and v to doubles, and a few roundings in their formulas, cost in ||x - x*||_W.
inline constexpr double roundings_of_a_formula = 4;

/// The prox x with v a subgradient at x, both by formula, in any metric: the bound is ||W(x - z) + v||_(W⁻¹),
/// in twice the working precision, and the rounding of x and v.
Prox closed_form(const Vector& z, const Metric& W, Vector x, Vector v);

/// A prox of a positively homogeneous f that is 0 but for rounding, less than u² of z, is 0 exactly: where
/// the domain is a cone, no tolerance relative to x could tell rounding from a point outside. x and z in W.
Prox without_rounding_at_zero(Prox prox, const Facts& facts, const Vector& z, const Metric& W);

/// W(x - z) + v in twice the working precision, rounded once: 0 at the exact solution.
Vector stationarity(const Vector& z, const Metric& W, const Vector& x, const Vector& v);

}  // namespace convex::inline composite
