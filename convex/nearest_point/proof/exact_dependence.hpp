#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/proof/exact_problem.hpp"

namespace convex {

/// Integers w without a common factor, w_a > 0 for one of them, with Σ w_a U_a = 0 in as many columns as the
/// rows are independent in; empty when there is more than one such w up to a factor.
IntegerVector dependence_of(const ExactProblem& exact);

/// Whether the equations u_r·q = s_r of the rows `others` imply that of row a (u_a·q >= s_a when it is
/// one-sided): u_a is exactly a combination of those rows, all of them needed, and s_a (at most) that of
/// their bounds. In integers.
bool follows_exactly(const NearestPointProblem&, Index a, const std::vector<Index>& others);

}  // namespace convex
