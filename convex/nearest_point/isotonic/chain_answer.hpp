#pragma once

#include "convex/nearest_point/isotonic/chain_pools.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// What the pools of a chain make of it, `first` as `pool` gives them, in twice the working precision and in
/// one pass: q, lambda, slack, the two norms, `rounding` and, as it stands, ||Aq - z - Uᵀlambda||_(A⁻¹) in
/// `residuals.stationarity`. False when that proves the pools wrong: means that fall, or a negative
/// multiplier; with `careful` pools it is rounding.
template <class Order>
bool place_pools(const Chain<Order>&, const std::vector<int>& first, bool careful, Solution&);

}  // namespace convex
