#pragma once

#include "convex/nearest_point/problem.hpp"

namespace convex::inline reductions {

/// The rows chosen, each divided by its length.
ConstraintRows divided(const ConstraintRows&, const std::vector<Index>& rows, const Vector& length);

/// A problem with rows divided by ||u_a||_(D⁻¹), D the diagonal of A, and all motions by one unit, so that
/// they are of size 1: for methods that measure steps and residuals without knowing the scale. Rows that are
/// 0 are left out.
struct ScaledProblem {
  explicit ScaledProblem(const NearestPointProblem&);

  NearestPointProblem problem;
  std::vector<bool> two_sided;
  std::vector<Index> rows;  ///< of the original
  Vector length;            ///< of each row
  double unit = 1;          ///< of motions, in the norm of A
  Index original_rows = 0;

  Vector motion(const Vector& q) const { return unit * q; }
  Vector multipliers(const Vector& lambda) const;
  Vector weights(const Vector& lambda) const { return multipliers(lambda) / unit; }
};

}  // namespace convex::inline reductions
