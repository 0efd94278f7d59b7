#pragma once

#include <optional>

#include "convex/nearest_point/optimality/refinement.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline dual_active_set {

/// The answer of the active-set method from its refined point, with residuals, status and an error bound:
/// what refinement left, the rounding of q to doubles, and what rows that contradict S by rounding leave
/// undecided. slack: Uq - s over all rows; row_scale: ||u_a||_(D⁻¹) of all rows, D the diagonal of A;
/// left_outside: Σ |d_p|/|v_p| over rows passed over as dependent, d_p being what S does not span of them, by
/// which a multiplier on them would act otherwise than on S; infinite when the method did not end by its own
/// test.
Solution certified_answer(const WorkingSet& set, const RefinedPoint& refined, const Vector& slack,
                          const Vector& row_scale, double left_outside, const Accuracy& accuracy,
                          Index steps);

/// The answer when rows contradict each other; `infeasible` only if the weights prove it. scale:
/// max(||q||_A, ||z||_(A⁻¹)). accuracy.limit = 0: without fractions.
Solution infeasible_answer(const NearestPointProblem&, const Vector& weights, double scale, Index steps,
                           const Accuracy&);

/// Weights that prove that no q satisfies the rows, whose numbers are known within radii, from weights w that
/// seem to. Large weights on a row and its near-multiple may hide in their roundings that the other rows do
/// not cancel. So the dual active set decides it, on the rows with weights alone: by rows of which one
/// depends on independent others, at a point that these allow. None where it finds a point. w: m; the result
/// too.
std::optional<Vector> contradiction_within_radii(const NearestPointProblem&, const Vector& w);

}  // namespace convex::inline dual_active_set
