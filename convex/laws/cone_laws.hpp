#pragma once

#include "convex/cones/cone_split.hpp"
#include "convex/laws/check.hpp"

namespace convex::inline law_checks {

/// What is tried of a polyhedral cone K, its polar K° in the metric, and, when there is a point, of its split
/// (Moreau 1962). All of it in exact arithmetic: every bound is 0, and values that are no lengths are
/// numbers of exceptions.
/// - every generator and line of a cone satisfies its half-spaces and equations;
/// - every half-space is tight on so many independent generators that it is a facet, and every generator is
///   an extreme ray;
/// - polar of polar: from the generators of K° alone, described anew, K comes back;
/// - x is in K, y in K°, (x|y) = 0, z = x + y, x and y each from the generators of its own cone;
/// - no other point of the cone is as near to z: (z - x|u - x) <= 0 for all generators and lines u.
LawReport cone_laws(const PolyhedralCone& K, const PolyhedralCone& polar_cone, const ExactMetric& W);
LawReport cone_laws(const PolyhedralCone& K, const PolyhedralCone& polar_cone, const ExactMetric& W,
                    const ExactVector& z, const ConeSplit& split);

}  // namespace convex::inline law_checks
