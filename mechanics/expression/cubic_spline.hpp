#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "convex/exact/fraction.hpp"
#include "mechanics/expression/rounded.hpp"

namespace mechanics::expression {

/// The natural cubic spline through (x_i, y_i): twice continuously differentiable, y'' = 0 at both ends (de
/// Boor 1978, chapter IV). On [x_i, x_(i+1)] it is y_i + u (slope_i + u (bend_i + u jerk_i)), u = x - x_i.
struct CubicSpline {
  std::vector<double> x, y;
  std::vector<Rounded> slope, bend, jerk;  ///< by piece

  double operator()(double at) const;  ///< NaN outside
};

/// The numbers of the pieces, not rounded.
struct ExactPieces {
  std::vector<convex::Fraction> slope, bend, jerk;
};
ExactPieces exact_pieces(std::span<const convex::Fraction> x, std::span<const convex::Fraction> y);

/// What is wrong with the numbers of a table: fewer than two, not finite, knots that do not increase.
std::optional<std::string> fault_of_table(std::span<const double> x, std::span<const double> y);

/// The radii of its numbers are bounds on what the data's radii and rounding do to them.
CubicSpline natural_cubic_spline(std::span<const Rounded> x, std::span<const Rounded> y);
CubicSpline natural_cubic_spline(std::span<const double> x, std::span<const double> y);

}  // namespace mechanics::expression
