#pragma once

#include <functional>
#include <optional>

#include "convex/gamma0/prox.hpp"
#include "convex/metric.hpp"

namespace convex::inline law_checks {

/// prox_f z in W from values and subgradients of a finite f alone (Kelley 1960): x is the prox of the largest
/// of the tangents taken so far, m <= f, and the next tangent is taken at x. Since both problems are strongly
/// convex, ||x - x*||_W² <= 2 (f(x) - m(x)): that is the bound, beside rounding. None where a value or a
/// subgradient is missing.
std::optional<Prox> prox_by_cutting_planes(
    const std::function<double(const Vector&)>& value,
    const std::function<std::optional<Vector>(const Vector&)>& subgradient, const Vector& z, const Metric& W);

}  // namespace convex::inline law_checks
