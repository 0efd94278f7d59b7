#pragma once

#include <limits>

#include "mechanics/expression/operation.hpp"

namespace mechanics::expression {

/// All numbers from `low` to `high`, which may be infinite; empty where low > high. Every operation contains
/// what it is of any numbers in its operands: ends are rounded outwards (Moore, Kearfott and Cloud 2009),
/// functions of the library of the system are trusted to some units of the last place.
struct Range {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool is_empty() const { return !(low <= high); }
  bool contains(double x) const { return low <= x && x <= high; }
};

inline constexpr Range nothing_in_range{1, 0};

Range intersection(Range a, Range b);
Range hull(Range a, Range b);

/// The values of an operation where it has one; empty where it has none. A unary one ignores b.
Range value(Operation operation, Range a, Range b);

/// Takes from a and b what cannot give a value in `result`.
void narrow(Operation operation, Range result, Range& a, Range& b);

}  // namespace mechanics::expression
