#pragma once

#include <vector>

#include "convex/constraint_rows.hpp"

namespace convex::inline isotonic {

/// The rows that are left when rows with a coordinate of their own are taken away again and again. A
/// combination of the rows given that vanishes has weight 0 on all others; so when nothing is left they are
/// independent, exactly: the rows of a forest, of a triangular matrix, of bounds. O(entries). rows:
/// increasing.
std::vector<Index> rows_left_by_peeling(const ConstraintRows& U, const std::vector<Index>& rows);

}  // namespace convex::inline isotonic
