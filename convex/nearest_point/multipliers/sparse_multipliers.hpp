#pragma once

#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace convex::inline multiplier_sets {

/// Whether the rows given are independent: by peeling where that decides, else by whether they hold firmly
/// (`is_held_firmly`), up to eigenvalues of 1e-8 of rows of length 1.
bool sparse_rows_are_independent(const NearestPointProblem&, const std::vector<Index>& rows);

/// Whether some direction d with u_a·d = 0 on the rows `held` opens all the others, u_b·d > 0. By the
/// theorem of Motzkin (1936) there is none exactly where Σ mu_a u_a + Σ mu_b u_b = 0 for some mu_b >= 0 that
/// are not all 0, of any sign on the working set: then multipliers 0 of the others are not the only ones. It
/// is the nearest point to 0 with u_b·d >= ||u_b||.
bool can_open(const NearestPointProblem&, const std::vector<Index>& held, const std::vector<Index>& opening);

/// The multipliers of least norm with the same Uᵀlambda on the tight rows, lambda_a >= 0 on the one-sided
/// ones: the nearest point to 0 in {lambda + mu : Uᵀmu = 0}, itself solved by the sparse method. False when
/// that gives up.
bool least_norm_multipliers(const NearestPointProblem&, const std::vector<Index>& tight, Vector& lambda);

}  // namespace convex::inline multiplier_sets
