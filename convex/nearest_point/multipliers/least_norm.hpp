#pragma once

#include <vector>

#include "convex/nearest_point/active_set/dependence.hpp"

namespace convex::inline multiplier_sets {

/// lambda of least norm: with lambda = lambda_0 + N mu, N the null vectors e_p - Σ T(k, p) e_k, the nearest
/// point to 0 in {mu : lambda >= 0 on one-sided rows}.
void least_norm(const Dependence& rows, const std::vector<bool>& is_free, Vector& lambda);

}  // namespace convex::inline multiplier_sets
