#pragma once

#include <vector>

#include "convex/nearest_point/sparse/row_system.hpp"

namespace convex::inline sparse {

/// What corrections leave of residuals of `rows`: powers of (I + S D)⁻¹, S = U A⁻¹Uᵀ in scaled units and D
/// the weights of all rows of the working set, applied to numbers without a pattern. It vanishes unless a
/// combination of the working set in which one of these has a part is 0 or nearly so: the power method for
/// the least eigenvalue of S, to be trusted as a random start is (Dixon 1983). system: factored with these
/// weights. m.
Vector slowest_residual(const BalancedProblem&, const RowSystem&, const std::vector<Index>& rows,
                        const Vector& weight);

/// Whether it vanished: each correction of the rows leaves but a small part, so that what is left of their
/// equations tells how far the point is from where they hold.
bool is_held_firmly(const Vector& slowest);

/// Whether Σ y_a u_a is 0 to the radii of the rows: some rows within them depend on each other so.
bool is_zero_within(const NearestPointProblem&, const BalancedProblem&, const Vector& y);

}  // namespace convex::inline sparse
