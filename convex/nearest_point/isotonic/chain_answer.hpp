#pragma once

#include <optional>

#include "convex/nearest_point/isotonic/chain_pools.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline isotonic {

/// What the pools of a chain make of it, `first` as `pool` gives them, in twice the working precision and in
/// one pass: q, lambda, slack, the two norms, `rounding` and, as it stands, ||Aq - z - Uᵀlambda||_(A⁻¹) in
/// `residuals.stationarity`. Returns the largest multiplier; none when that proves the pools wrong: means
/// that fall, or a negative multiplier; with `careful` pools it is rounding. Slacks between pools are 0 only
/// where they are so without rounding; `undecided` where that takes too long.
template <class Order>
std::optional<double> place_pools(const Chain<Order>&, const std::vector<int>& first, bool careful,
                                  Solution&);

/// What sums of n terms in twice the precision lose, in the norm of A. scale: of q and of z.
template <class Order>
double rounding_of_pools(const Chain<Order>&, double scale);

}  // namespace convex::inline isotonic
