#pragma once

#include "convex/metric.hpp"
#include "mechanics/motion/arc.hpp"

namespace mechanics {

/// The order for a tolerance: -ln(tol)/2 + 1 makes the work for a given length of time least (Jorba and Zou
/// 2005, section 3.2), two more serve the derivatives.
int taylor_order(double tolerance);

/// The largest h with ||q_k||_A h^k <= tolerance · max_(0<j<k) ||q_j||_A h^j for the last two orders k that
/// are not 0: the error of a step against what the system moves in it, whatever the units and the origin.
/// Infinite when q is a polynomial of at most half the order, as far as its coefficients tell.
double step_length(const Arc& arc, const convex::Metric& A, double tolerance);

}  // namespace mechanics
