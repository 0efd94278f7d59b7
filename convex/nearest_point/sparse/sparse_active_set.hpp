#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline sparse {

/// For many coordinates and sparse A and U: an interior-point start shows which rows are active, and the
/// equations of these, made definite by a small weight on the multipliers, are refined against the original
/// data in twice the working precision (docs/methods/sparse-active-set.md). Redundant rows are ordinary
/// input. One order of elimination serves all.
///
/// Rows with a wrong sign are exchanged, all at once, as long as fewer are wrong each time; then the start is
/// taken closer, at most a fixed number of times. It ends with a point that has no wrong sign, with a Farkas
/// witness, or with `gave_up`; steps are those of the start and exchanges. guess: rows thought to be active;
/// the start is left out when it proves right. Throws InvalidInput as `validate` does.
Solution sparse_active_set(const NearestPointProblem&, const Accuracy& = {},
                           const std::vector<Index>& guess = {});

/// From the point and the multipliers of another method, and the one-sided rows that these show to be active:
/// the solution where a few exchanges lead to it, else `gave_up`. What is open is said, and not decided.
Solution sparse_active_set_near(const NearestPointProblem&, const Vector& q, const std::vector<Index>& rows,
                                const Vector& lambda);

}  // namespace convex::inline sparse
