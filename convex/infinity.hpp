#pragma once

#include <limits>

namespace convex {

/// +inf: the value of a function off its domain, the end of an interval that has none.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Whether the root of a sum of squares may be trusted that is this: beyond, squares are no doubles, or have
/// lost digits.
constexpr bool has_squares(double norm) { return norm > 0x1p-480 && norm < 0x1p480; }

}  // namespace convex
