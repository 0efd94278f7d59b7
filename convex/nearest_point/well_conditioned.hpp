#pragma once

#include <optional>
#include <vector>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// The short way of the active-set method, for dense A and U where nothing is in doubt: principal pivoting by
/// blocks (Júdice and Pires 1994; Kunisch and Rendl 2003) on the Gram matrix of the whitened rows, then one
/// correction with residuals of the original data in twice the working precision. None when a sign cannot be
/// told from rounding, when rows held are nearly dependent, when the correction is not small, or when
/// pivoting does not settle: then the long way decides. The answer meets the same tests as there, and its
/// error bound is made of the same parts. The data are checked. guess: rows thought to be active.
std::optional<Solution> well_conditioned(const NearestPointProblem&, const Accuracy&,
                                         const std::vector<Index>& guess);

/// Whether the short way is open to a problem of that size and kind.
bool has_short_way(const NearestPointProblem&);

}  // namespace convex
