#pragma once

#include "convex/metric.hpp"
#include "mechanics/motion/arc.hpp"

namespace mechanics {

/// Errors of steps add up and are carried on, so that a step aims at so much less than the tolerance: the
/// work grows with its logarithm only.
inline constexpr double part_of_a_step = 1e-6;

/// The tolerance that a step aims at; doubles have no less than their rounding.
double tolerance_of_step(double tolerance);

/// The order for a tolerance of steps: -ln(tol)/2 + 1 makes the work for a given length of time least (Jorba
/// and Zou 2005, section 3.2), two more serve the derivatives.
int taylor_order(double tolerance);

/// The largest h with ||q_k||_A h^k <= tolerance · max_(0<j<4) ||q_j||_A h^j for the last two orders k that
/// are not 0: the error of a step against what the system moves in it, whatever the units and the origin.
/// Infinite when q is a polynomial of at most half the order, as far as its coefficients tell.
double step_length(const Arc& arc, const convex::Metric& A, double tolerance);

/// The same for one function: as far as its series can be trusted in a search for zeros.
double trusted_length(std::span<const double> c, double tolerance);

}  // namespace mechanics
