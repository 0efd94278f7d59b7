#pragma once

#include "convex/nearest_point/problem.hpp"

namespace convex::inline reductions {

/// The rows chosen, each divided by its length.
ConstraintRows divided(const ConstraintRows&, const std::vector<Index>& rows, const Vector& length);

/// Rows divided by their lengths, those that are 0 left out, and all motions by one unit, in the norm of A.
struct ScaledRows {
  std::vector<Index> rows;      ///< of the original
  std::vector<bool> two_sided;  ///< of each
  Vector length;                ///< of each
  double unit = 1;
  Index original_rows = 0;

  Vector motion(const Vector& q) const { return unit * q; }
  /// Multipliers, and Farkas weights, of the original from those of these rows.
  Vector multipliers(const Vector& lambda) const;
  Vector weights(const Vector& lambda) const { return multipliers(lambda) / unit; }
};

/// A problem with rows divided by ||u_a||_(D⁻¹), D the diagonal of A, and all motions by one unit, so that
/// they are of size 1: for methods that measure steps and residuals without knowing the scale. Rows that are
/// 0 are left out.
struct ScaledProblem : ScaledRows {
  explicit ScaledProblem(const NearestPointProblem&);

  NearestPointProblem problem;
};

}  // namespace convex::inline reductions
