#pragma once

#include <optional>

#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// t f + (1-t) g averaged in M/gamma, 0 < t < 1.
struct AverageOf {
  const Function &f, &g;
  double t = 0.5, gamma = 1;
  Metric M;
};

/// A value of an average, and a subgradient there.
struct AverageAt {
  Value value;
  Vector v;
};

/// t f(p) + (1-t) g(q) + t(1-t)/(2 gamma) ||p - q||² with t p + (1-t) q = x, q given: no less than the
/// average at x, whose slope there tells what it costs that the points may miss their domains.
Value average_with_second(const AverageOf&, const Vector& q, const Vector& x,
                          const std::optional<Vector>& slope);

/// At an end of the domain, where p and q are at the ends of theirs; none elsewhere, and for more entries
/// than one.
std::optional<Value> average_at_end_of_domain(const AverageOf&, const Vector& x);

/// The average at x by the proxes of f and g in M/gamma: its own is their mean (Bauschke, Goebel, Lucet and
/// Wang 2008, Theorem 6.1). A u whose mean p, q is x gives the subgradient (M/gamma)(u - x), and the two
/// points give the value. Envelopes go with the proxes, t e_f + (1-t) e_g at u less ½||u - x||² is no more
/// than the average at x, whatever u is; the error is the difference and the rounding of the terms. u is the
/// root of a nonexpansive, monotone map: Newton's steps by differences, of one entry those of a bracket.
/// None where they do not get there, as at an end of the domain.
std::optional<AverageAt> average_by_proxes(const AverageOf&, const Vector& x);

}  // namespace convex::inline operations
