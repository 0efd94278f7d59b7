#pragma once

#include <limits>

namespace convex {

/// +inf: the value of a function off its domain, the end of an interval that has none.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace convex
