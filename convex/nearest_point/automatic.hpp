#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// The default: no more work than the problem needs (docs/methods/auto.md). Rows that provably cannot
/// matter are left out, the rest falls into islands, and each is solved by the smallest method that fits: a
/// formula for none or one row, a kernel for chains and obstacles, the dense active set for what is
/// small, the sparse one for what is not. The residuals are those of the whole. `model` says what was done.
///
/// guess: rows thought to be active, for a warm start; empty when nothing is known. accuracy.reduce = false:
/// the whole by one general method. Throws InvalidInput as `validate` does.
Solution automatic(const NearestPointProblem&, const Accuracy& = {}, const std::vector<Index>& guess = {});

}  // namespace convex
