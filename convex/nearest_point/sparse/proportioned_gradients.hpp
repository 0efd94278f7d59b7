#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline sparse {

/// The dual, ½ lambda·M lambda - b·lambda over lambda_a >= 0 (free on two-sided rows), M = U A⁻¹ Uᵀ and
/// b = s - U A⁻¹z, by conjugate gradients on a face, projected where they leave it, and steps off it where
/// the multipliers at 0 push more than the others (proportioning; Dostál 1997, Dostál and Schöberl 2005).
/// Rows may depend on each other. A step costs a product with U, one with Uᵀ and a solve with A: for motions
/// in which very many rows change from one problem to the next, and few digits are enough.
///
/// guess: multipliers to begin with, m of them, or none. It ends when the estimate of ||q - q*||_A is at most
/// tolerance * max(||q||_A, ||z||_(A⁻¹)): the root of twice what the objective has fallen by in the last
/// steps, since
/// ||q - q*||_A² is twice what is left of it (Hestenes and Stiefel 1952; Strakoš and Tichý 2002).
/// `inaccurate` where the step limit comes first, as where the rows contradict each other. Throws
/// InvalidInput as `validate` does.
Solution proportioned_gradients(const NearestPointProblem& problem, const Accuracy& accuracy,
                                const Vector& guess = {});

}  // namespace convex::inline sparse
