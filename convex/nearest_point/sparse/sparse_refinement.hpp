#pragma once

#include <vector>

#include "convex/double_double.hpp"
#include "convex/nearest_point/sparse/row_system.hpp"

namespace convex::inline sparse {

/// The weight on the multipliers, and how it shrinks where it makes corrections slow.
inline constexpr double first_delta = 1e-7, smaller_delta = 1e-2;
inline constexpr int most_deltas = 3;

/// The largest |x_i|; 0 of none.
inline double largest_entry(const Vector& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0; }

/// Rows are held when what is left of them is this part of the scale.
inline constexpr double held_to = 0x1p-58;

/// A point with its multipliers, as pairs of doubles, in the units of the original problem.
struct SparsePoint {
  DoubleDoubleVector q, lambda;      ///< n; m
  Vector last_lambda;                ///< |last correction| of the multipliers, scaled: m
  double last = 0, contraction = 0;  ///< ||dq||_A of the last correction in scaled units, and its shrinking
  double floor = 0;         ///< what the rounding of residuals in twice the precision leaves of it, scaled
  double dropped = 0;       ///< ||.||_A of what was taken for noise about zero, scaled
  double rest = 0;          ///< the largest of U_S q - s_S before the last correction, scaled
  bool to_the_end = false;  ///< corrections go on until rounding ends them
  bool converged = false;
  bool wrong_signs = false;  ///< ended early
  double remaining() const {
    return (contraction < 1 ? last * contraction / (1 - contraction) : last) + floor;
  }
};

/// Makes 0 of what may be missing in an entry of q.
void drop_noise(const BalancedProblem&, SparsePoint&);

/// Weights for `refine_rows`: 1/delta on the rows given, 0 on the others.
Vector even_weights(Index row_count, const std::vector<Index>& rows, double delta);
/// Up to a hundred times more on rows whose multiplier is large: where rows are redundant the multipliers
/// then move in proportion to their squares, as in an affine scaling step (Dikin 1967), so that small ones
/// stay positive.
Vector central_weights(const BalancedProblem&, const std::vector<Index>& rows, double delta,
                       const SparsePoint& point);

/// Corrects `point` towards A q - U_Sᵀlambda = z, U_S q = s_S by residuals of the original data in twice the
/// working precision; the preconditioner is that system with -1/weight in the corner (the augmented
/// Lagrangian, Hestenes 1969, Powell 1969), so that redundant rows are no matter and each correction leaves
/// 1 / (1 + weight·eigenvalue of U_S A⁻¹U_Sᵀ). Starting multipliers are changed as little as the equations
/// allow, in units of the weights. rows: S, increasing. It ends early when a one-sided multiplier is plainly
/// negative, which is all there is to know. False when the factorisation breaks down.
bool refine_rows(const NearestPointProblem&, const BalancedProblem&, RowSystem&,
                 const std::vector<Index>& rows, const Vector& weight, double zero, SparsePoint& point);

}  // namespace convex::inline sparse
