#pragma once

#include <cmath>

#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::inline optimality {

/// Corrections are made until what is left lies so far below the scale of the problem: the sixty bits that a
/// rounded answer and the signs of its slacks can need.
inline constexpr double enough = 0x1p-68;

/// A correction below this part of the scale is made of the rounding of the residuals, which the condition of
/// A enlarges: it does not shrink any more.
inline constexpr double at_rounding = 0x1p-80;

/// Corrections that shrink no faster are not to be trusted; and there are at most so many.
inline constexpr double trusted_contraction = 0.25;
inline constexpr int most_refinements = 40;

/// By what corrections shrink what is missing, estimated from conditions: A + E is factored instead of A,
/// which leaves u times the condition of A, that of its factor squared; the whitened rows are rounded with
/// that factor; and the rows of the working set are factored with the condition of their Gram matrix where
/// that is what is factored, else with its root. gram_condition: of rows divided by their lengths.
inline double expected_contraction(double factor_condition, double gram_condition, bool by_gram_matrix) {
  const double rows = std::sqrt(gram_condition);
  return unit_roundoff *
         (factor_condition * (factor_condition + rows) + (by_gram_matrix ? gram_condition : rows));
}

/// What a correction usually leaves: the bound on the error counts on `expected_contraction`, the zero about
/// which an entry is called rounding on this, so that small numbers are kept.
inline double usual_contraction(double factor_condition, double gram_condition) {
  return unit_roundoff * (factor_condition + std::sqrt(gram_condition));
}

/// What the rounding of a correction leaves of ||dq||_A, by its part that changes the multipliers, times the
/// lengths of their rows: rows that are nearly opposite cancel there, so that ||dq||_A alone may be far less
/// than what it was made of. Of orthogonal factors QR = V + E, |E| <= u |V|, Eᵀdlambda is left, `growth` 1;
/// of the Gram matrix G, (G + E)(dlambda + e) = r, |E| <= u |G|, Vᵀe is left, of the root of the condition of
/// G; and an inverse of G has a growth of its own (Higham, Accuracy and Stability, 2002, §14.4 and 19.3).
inline double pull_rounding(double factor_condition, double growth) {
  return unit_roundoff * (factor_condition + growth);
}

/// An entry that the correction takes to this part of it is 0 as far as that tells.
inline constexpr double cancelled = 0x1p-24;

/// An estimate of ||q - q_S||_A for a point found and judged in doubles. stationarity: ||Aq - z -
/// Uᵀlambda||_(A⁻¹) and held: |slacks of the k rows of the working set| times the norm of the inverse of
/// their factor, as measured; scale: the size of what was summed, times the condition; each of n + k terms is
/// rounded, with room to spare.
inline double bound_of_doubles(Index n, Index k, double stationarity, double held, double scale) {
  return stationarity + held + 8 * static_cast<double>(n + k) * unit_roundoff * scale;
}

/// The point and multipliers of a working set, to twice the working precision where its conditioning allows.
struct RefinedPoint {
  DoubleDoubleVector q;       ///< n
  DoubleDoubleVector lambda;  ///< over S
  double first = 0;           ///< ||dq||_A of the first correction: the rounding of the plain solve
  double last = 0;            ///< ||dq||_A of the last correction
  double contraction =
      0;  ///< by what each correction is smaller than the one before: as seen, and at least condition times u
  double floor =
      0;  ///< what the rounding of residuals in twice the precision leaves, enlarged by the condition
  double dropped = 0;  ///< at least ||·||_A of what was taken for rounding noise about zero
  /// An estimate of what is still missing, ||q - q_S||_A, q_S the exact point of the working set, but for
  /// what was dropped.
  double remaining() const {
    return contraction < 1 ? last * contraction / (1 - contraction) + floor
                           : std::numeric_limits<double>::infinity();
  }
};

/// Iterative refinement against the original KKT system A q - U_Sᵀ lambda = z, U_S q = s_S with residuals in
/// twice the working precision (Wilkinson 1963; Björck 1967 for the augmented system); the factor of S is the
/// preconditioner, so the error shrinks by about (condition of S) u each time.
RefinedPoint refine(const WorkingSet& set);

/// The place in S of the one-sided row whose multiplier, times its length, is most negative, below -noise; -1
/// for none. lambda: over S.
Index most_negative(const WorkingSet& set, const Vector& lambda, double noise);
/// The same of a refined one, beyond what may be missing in it.
Index most_negative(const WorkingSet& set, const RefinedPoint& refined);

/// u_a·q - s_a of all rows at a refined point: 0 on the working set; those near zero in twice the working
/// precision, and 0 when they cannot be told from it. A violation so taken for 0 may move the edge of rows at
/// a small angle: that is added to `dropped` of the point. row_scale: ||u_a||_(D⁻¹), D the diagonal of A.
Vector refined_slacks(WorkingSet& set, RefinedPoint& point, const Vector& row_scale);

}  // namespace convex::inline optimality
