#pragma once

#include <span>

#include "mechanics/motion/taylor_steps.hpp"

namespace mechanics::inline motions {

/// Errors of steps add up and are carried on, so that a step aims at so much less than the tolerance: the
/// work grows with its logarithm only.
inline constexpr double part_of_a_step = 1e-6;

/// The tolerance that a step aims at; doubles have no less than their rounding.
double tolerance_of_step(double tolerance);

/// The order for a tolerance of steps. The length of a step is ρ tol^(1/N) with ρ the radius of convergence.
/// Were the work of a step N², as much as its products, -ln(tol)/2 + 1 would make the work for a given length
/// of time least (Jorba and Zou 2005, section 3.2); were it N, -ln(tol). It lies between, and the least is
/// flat: measured, 0.7 to 1 cost the same within a tenth, but longer steps lose digits: the terms of an
/// entire series, as an oscillation's, grow to e^h before they cancel.
int taylor_order(double tolerance);

/// The largest h with ||q_k||_A h^k <= tolerance · max_(0<j<4) ||q_j||_A h^j for the last two orders k that
/// are not 0: the error of a step against what the system moves in it, whatever the units and the origin.
/// Infinite when q is a polynomial of at most half the order, as far as its coefficients tell.
/// sizes: ||q_k||_A, by order.
double step_length(std::span<const double> sizes, double tolerance);

/// The same for one function: as far as its series can be trusted in a search for zeros.
double trusted_length(std::span<const double> c, double tolerance);

/// How far the argument u of exp, sin, sinh may move in a step. The series of such a function beyond order N
/// is less than tol where |δu|^N/N! <= tol; with a little room, since series themselves tell that too.
double reach_of_argument(int order, double tolerance);

/// The largest h <= step in which the argument u = Σ u_k τ^k moves by at most its reach, or the function is
/// constant to the last digit (exp of what stays below the logarithm of the least double). Coefficients at
/// the beginning do not tell what lies further: all those of exp(-(t - 2)²/w²) are 0 there. The reach of tan
/// and tanh, which have poles, is 1.
double seen_length(std::span<const double> argument, TaylorStep::Kind of, double step, double reach);

}  // namespace mechanics::inline motions
