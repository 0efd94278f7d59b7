#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline dual_active_set {

/// The dual active-set method (Goldfarb and Idnani 1983) on whitened rows, finished by refinement against the
/// original KKT system: on their Gram matrix, by blocks where these settle; what is in doubt goes on with an
/// updated orthogonal factor, what is open then in fractions (docs/methods/active-set.md).
///
/// Finite: every full step raises the dual objective strictly, and between two full steps rows are only
/// dropped, so no set of rows returns; dependent rows are never taken in. Redundant, repeated, weakly active
/// rows and implicit equalities need no assumption. Blocks are limited in number and prove nothing.
///
/// Throws InvalidInput as `validate` does.
/// `guess`: rows thought to be active; empty when nothing is known.
Solution active_set(const NearestPointProblem&, const Accuracy& = {}, const std::vector<Index>& guess = {});

/// The same for a problem and a guess that have been checked.
Solution active_set_of_valid(const NearestPointProblem&, const Accuracy&, const std::vector<Index>& guess);

/// From rows that a method shows to be active, with its multipliers, the most loaded first: the solution,
/// where it takes no more than so many changes of the working set to come to it; else without a finite bound.
/// What doubles leave open is said, and not decided.
Solution active_set_near(const NearestPointProblem&, const std::vector<Index>& rows, const Vector& lambda,
                         Index most_changes);

}  // namespace convex::inline dual_active_set
