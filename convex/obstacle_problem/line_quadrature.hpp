#pragma once

#include <array>
#include <functional>

namespace convex::inline obstacle_problem {

/// Points and weights of Gauss and Legendre's rule on [-1, 1]; exact to degree 15.
struct GaussLegendre {
  std::array<double, 8> point, weight;
  /// What the polynomial through values at the points is at the ends -1 and 1: the sums with these.
  std::array<double, 8> at_low, at_high;
};
const GaussLegendre& gauss_legendre();

/// The weight r^power on a line, and what follows from it.
struct LineWeight {
  int power = 0;
  double operator()(double r) const { return power == 0 ? 1 : power == 1 ? r : r * r; }
  /// ∫ dt / w(t) from a to b; infinite from 0 where power > 0.
  double resistance(double a, double b) const;
};

/// Over a cell [a, b]: the load ∫ w h and its moment ∫ w h R(τ, b), R the resistance; of absolute values too;
/// R(a, b); the largest w h > 0 at the points of the rule, else 0; how much w h goes up and down on them, and
/// what the polynomial through them is at the ends.
struct CellLoad {
  double load = 0, moment = 0, absolute = 0, absolute_moment = 0, resistance = 0, largest_source = 0,
         variation = 0, at_low = 0, at_high = 0;
};
CellLoad cell_load(const std::function<double(double)>& h, LineWeight, double a, double b);

}  // namespace convex::inline obstacle_problem
