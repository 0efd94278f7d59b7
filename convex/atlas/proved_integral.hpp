#pragma once

#include <functional>

#include "convex/interval.hpp"

namespace convex::atlas {

/// A function of one variable that is real on the real line, by what proves an integral of it.
struct AnalyticFunction {
  /// Contains f at every point of an interval.
  std::function<Interval(const Interval&)> at;
  /// At least |f(u + iv)| for u and v in these intervals, v >= 0; +inf where f is not known to be analytic at
  /// all points between them and the real line.
  std::function<double(const Interval& u, const Interval& v)> size;
  /// Contains all its values on the interval of integration.
  Interval range;
  /// Beyond ± this number on the real line it is thought not to be analytic; where to try ellipses.
  double singularity = 0;
};

/// Contains the integral of f from 0 to `end`, which may be negative. A panel of half the length h is
/// integrated by Gauss' rule of N points where that is proved to err by less than a share of the tolerance:
/// for |f| <= M on the ellipse of foci at its ends and sum of half-axes h rho the rule errs by at most
///   8 h M rho^-(2N-1) / (rho - 1),
/// the Chebyshev series of f being cut off at the degree that the rule is exact for (Bernstein 1912;
/// Trefethen 2013, theorem 8.2). Else it is halved, until its length times the range is less than the share.
/// What comes out may be wider than the tolerance.
Interval proved_integral(const AnalyticFunction& f, double end, double tolerance);

}  // namespace convex::atlas
