#pragma once

#include "convex/gamma0/prox.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/metric.hpp"

namespace convex::linear_quadratic {

/// argmin ½||x - z||_W² + f(x), over x and the auxiliary variables at once, by the active-set method
/// (minimise.hpp). v is found from the multipliers, v = (Hξ + c - Gᵀlambda)_x, never as W(z - x). The status
/// is `infeasible`, with the reason in `method` and x empty, when f is improper. z: n. Throws InvalidInput
/// when sizes do not fit.
Prox prox(const LinearQuadratic& f, const Vector& z, const Metric& W);

}  // namespace convex::linear_quadratic
