#pragma once

#include "convex/nearest_point/working_set.hpp"

namespace convex {

/// The point and multipliers of a working set, to twice the working precision where its conditioning allows.
struct RefinedPoint {
  DoubleDoubleVector q;       ///< n
  DoubleDoubleVector lambda;  ///< over W
  double first = 0;           ///< ||dq||_A of the first correction: the rounding of the plain solve
  double last = 0;            ///< ||dq||_A of the last correction
  double contraction =
      0;  ///< by what each correction was smaller than the one before (about condition times u)
  /// An estimate of what is still missing, ||q - q_W||_A, q_W the exact point of the working set.
  double remaining() const {
    return contraction < 1 ? last * contraction / (1 - contraction) : std::numeric_limits<double>::infinity();
  }
};

/// Iterative refinement against the original KKT system A q - U_Wᵀ lambda = z, U_W q = s_W with residuals in
/// twice the working precision (Wilkinson 1963; Björck 1967 for the augmented system); the factor of W is the
/// preconditioner, so the error shrinks by about (condition of W) u each time.
template <int MaxSize>
RefinedPoint refine(const WorkingSet<MaxSize>& set);

}  // namespace convex
