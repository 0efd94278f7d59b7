#pragma once

#include "convex/nearest_point/multipliers/multipliers.hpp"

namespace mechanics {

using convex::Index;

/// The one-sided rows with u_a·q'' = s_a that push for no choice of the multipliers: to second order they
/// neither press nor open. lambda_a u_a is 0 within rounding of the largest force; or it is within the
/// tolerance of that, and without the row the acceleration is the same as far as its bounds tell. None where
/// multipliers are neither unique nor given by ranges.
std::vector<Index> touching_contacts(const convex::NearestPointProblem&, const convex::Solution&,
                                     const convex::Multipliers&, double tolerance);

/// Leaves out the rows whose multiplier is more than its own error, whatever is pressed elsewhere. With d,
/// u_a·d = 1, u_b·d = 0 for the other rows that are tight and ||d||_A least, lambda_a = d·(A q'' - z); of
/// that the error bound of q'' moves ||d||_A times itself, and `balance` (n), how far z + Σ lambda_a u_a - A
/// q'' may be from the one that is meant, |d|·balance. Rows that depend on others stay.
void leave_out_pressing(std::vector<Index>& touching, const convex::NearestPointProblem&,
                        const convex::Solution&, const convex::Multipliers&, const convex::Vector& balance);

/// Whether doubles leave open if some of these rows can press: its largest multiplier is not 0, and it
/// depends on others, so that it has no error of its own.
bool may_press(const std::vector<Index>& touching, const convex::NearestPointProblem&,
               const convex::Multipliers&);

}  // namespace mechanics
