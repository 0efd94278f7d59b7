#pragma once

#include "convex/exact/integer.hpp"

namespace convex::inline exact_arithmetic {

/// A vector of minors at right angles to r - 1 rows of r entries; empty when they are dependent. Computed in
/// words of 64 or 128 bits where Hadamard's bound on the minors shows that they hold every number.
IntegerVector normal_by_minors(const std::vector<const IntegerVector*>& rows, std::size_t r);

}  // namespace convex::inline exact_arithmetic
