#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// How far from x, in ||·||_W, the prox may be that x is told to be, where f is a maximum and the errors of
/// its parts' values hide which of these is the largest: f_k - f_l is right to e, with slopes v_k and v_l.
/// Where they are one is right to e / ||v_k - v_l||_(W⁻¹); and a prox with one slope for the other is right
/// to ||v_k - v_l||_(W⁻¹), being nonexpansive. 0 for other functions, and where one part is the largest.
double doubt_of_ties(const Function& f, const Vector& x, const Metric& W);

/// Do the errors of the values of a maximum hide which of different slopes it has at x?
bool is_tied(const Function& f, const Vector& x);

}  // namespace convex::inline operations
