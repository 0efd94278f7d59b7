#pragma once

#include "convex/exact/integer.hpp"

namespace convex::inline cones {

/// One side of Gordan's alternative (1873) for vectors g_j: either y with y·g_j > 0 for all j, or a set of j
/// for which some positive combination of the g_j is 0.
struct StrictFunctional {
  IntegerVector y;                     ///< empty when there is none
  std::vector<std::size_t> dependent;  ///< then not empty: these g_j and their opposites are in the cone
};

/// Exact: the simplex method on max Σ lambda_j over Σ lambda_j g_j = const, lambda >= 0, with integer pivots,
/// and Bland's rule (1977) where the objective stands still, so that it ends. The rows span r dimensions,
/// none is 0. A y that makes small numbers, such as a coordinate, is tried first.
StrictFunctional strict_functional(const IntegerRows& rows, std::size_t r);

}  // namespace convex::inline cones
