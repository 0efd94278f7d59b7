#pragma once

#include <vector>

#include "convex/double_double.hpp"
#include "convex/nearest_point/structure/row_system.hpp"

namespace convex {

/// A point with its multipliers, as pairs of doubles, in the units of the original problem.
struct SparsePoint {
  DoubleDoubleVector q, lambda;      ///< n; m
  Vector last_lambda;                ///< |last correction| of the multipliers, scaled: m
  double last = 0, contraction = 0;  ///< ||dq||_A of the last correction in scaled units, and its shrinking
  double rest = 0;                   ///< the largest of U_W q - s_W before the last correction, scaled
  bool converged = false;
  double remaining() const { return contraction < 1 ? last * contraction / (1 - contraction) : last; }
};

/// Corrects `point` towards A q - U_Wᵀlambda = z, U_W q = s_W by residuals of the original data in twice the
/// working precision; the preconditioner is that system with -delta I in the corner (the augmented
/// Lagrangian, Hestenes 1969, Powell 1969), so that redundant rows are no matter and each correction leaves
/// delta / (delta + eigenvalue of U_W A⁻¹U_Wᵀ). Starting multipliers are changed as little as the equations
/// allow. rows: W, increasing. False when the factorisation breaks down.
bool refine_rows(const NearestPointProblem&, const BalancedProblem&, RowSystem&,
                 const std::vector<Index>& rows, double delta, double silence, SparsePoint& point);

}  // namespace convex
