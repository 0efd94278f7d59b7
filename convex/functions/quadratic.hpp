#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline named_functions {

/// ½ x·Qx + c·x + constant. Q: n×n, symmetric (to rounding) positive semidefinite, else InvalidInput; c: n.
/// The prox is (W + Q)⁻¹(Wz - c) in any metric.
Function quadratic(const Matrix& Q, const Vector& c, double constant = 0);

}  // namespace convex::inline named_functions
