#pragma once

#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace convex::inline multiplier_sets {

/// Whether the rows given are independent: by peeling where that decides, else by what a vector drawn by lot
/// keeps in the null space of the columns u_a, up to eigenvalues of 1e-8 of rows of length 1.
bool sparse_rows_are_independent(const NearestPointProblem&, const std::vector<Index>& rows);

/// The multipliers of least norm with the same Uᵀlambda on the tight rows, lambda_a >= 0 on the one-sided
/// ones: the nearest point to 0 in {lambda + mu : Uᵀmu = 0}, itself solved by the sparse method. False when
/// that gives up.
bool least_norm_multipliers(const NearestPointProblem&, const std::vector<Index>& tight, Vector& lambda);

}  // namespace convex::inline multiplier_sets
