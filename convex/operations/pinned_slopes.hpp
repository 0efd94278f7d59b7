#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// f on n entries with another function in place of it that has the same f □ g, where the slopes that f and g
/// have in common, the v in dom f* ∩ dom g*, all have one v_i = c_i: an entry f_i of a separable f is then
/// c_i x_i - f_i*(c_i), as (f □ g)* = f* + g* sees of f_i* that one value (Rockafellar 1970, Theorem 16.4).
/// The infimum is not attained where f_i only comes near to that line, as 1/x to 0, and a program that goes
/// after it ends far out with a value that is not the limit.
///
/// The entries of v are bounded by the recession functions of f and g along the axes, and by the rows of dom
/// g* where g is piecewise linear-quadratic; the least and the largest v_i are found in fractions. None where
/// no entry is pinned, or f of several entries is not separable.
std::optional<Function> with_pinned_slopes(const Function& f, const Function& g, Index n);

}  // namespace convex::inline operations
