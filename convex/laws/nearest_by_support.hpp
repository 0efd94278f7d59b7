#pragma once

#include <functional>
#include <optional>

#include "convex/gamma0/prox.hpp"
#include "convex/metric.hpp"

namespace convex::inline law_checks {

/// A point s of a bounded closed convex set S with the largest (s|c); none where that is not known.
using SupportPoint = std::function<std::optional<Vector>(const Vector& c)>;

/// The nearest point of S to z in W from support points alone (Wolfe 1976; Frank and Wolfe 1956, fully
/// corrected): x is the nearest point of the hull of those found so far, and the next is the one for z - x.
/// It knows neither the projection on S nor the prox of its support function, and so is evidence beside both.
/// The bound is sqrt(g), g = max over s in S of (z - x|s - x), beside rounding. None without support points.
std::optional<Prox> nearest_by_support(const SupportPoint&, const Vector& z, const Metric& W);

}  // namespace convex::inline law_checks
