#pragma once

#include "convex/piecewise/segment.hpp"

namespace convex::inline piecewise_quadratics {

/// Where to anchor what is made of two pieces on [from, to]: at the anchor of one of them, the one nearer to
/// the interval, for far from it values cancel; on equal distance at that of the curved one, then at the
/// one nearer to 0, where coefficients are read off without rounding.
double common_anchor(const Segment& a, const Segment& b, double from, double to);

}  // namespace convex::inline piecewise_quadratics
