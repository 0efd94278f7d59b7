#pragma once

#include "convex/gamma0/function.hpp"

/// Closed convex cones. The conjugate of the indicator of each is that of its polar.
namespace convex::inline named_functions {

/// {(v, t) : |v|₂ <= t}, t last.
Set second_order_cone();
/// {(v, a, b) : |v|₂² <= 2ab, a, b >= 0}, a and b last.
Set rotated_second_order_cone();
/// Symmetric positive semidefinite matrices stacked by columns, n·n entries.
Set psd_cone();
/// The closure of {(x, y, t) : y > 0, y e^(x/y) <= t}.
Set exponential_cone();
/// {u : u·x >= 0 on the exponential cone}, the closure of {(u, v, w) : u < 0, -u e^(v/u) <= e w}.
Set dual_exponential_cone();
/// {(x, y, z) : x^alpha y^(1-alpha) >= |z|, x, y >= 0}, 0 < alpha < 1.
Set power_cone(double alpha);
/// {(u, v, w) : (u/alpha)^alpha (v/(1-alpha))^(1-alpha) >= |w|, u, v >= 0}, 0 < alpha < 1.
Set dual_power_cone(double alpha);
/// {x : x_1 <= x_2 <= … <= x_n}; its projection is isotonic regression.
Set monotone_cone();

}  // namespace convex::inline named_functions
