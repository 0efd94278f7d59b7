#pragma once

#include <functional>

#include "convex/vector.hpp"

namespace mechanics::inline motions {

/// X(length) of X' = J(tau) X, X(0) = 1, by collocation at Gauss' points, of order 16 (Hairer, Nørsett and
/// Wanner 1993, section II.7). A piece whose two halves tell another X is halved.
convex::Matrix linear_flow(const std::function<convex::Matrix(double)>& J, double length);

}  // namespace mechanics::inline motions
