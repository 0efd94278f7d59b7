#pragma once

#include <vector>

#include "convex/composite/newton_system.hpp"
#include "convex/linear_algebra/pivoted_lu.hpp"

namespace convex::inline composite {

/// The equations of `NewtonSystem` with the dt of stiff rows as unknowns,
///   (G + ridge) dxi + MᵀD(I - J) dt = -rho,  B dt - M dxi = r,  B = J + theta (I - J),
/// solved by elimination with row pivots. Where B is small, eliminating dt puts D/theta into the matrix,
/// whose rounding hides the curvature that alone holds a w or an x where a multiplier vanishes; here theta
/// may be near rounding. It tells how far a solution moves. Steps are taken by the other, which is definite,
/// smaller, and meets the rows held more closely.
class SensitivitySystem {
 public:
  SensitivitySystem(const SaddleProblem&, const Vector& t, const Vector& D, double theta,
                    const Vector& ridge);
  NewtonStep step(const Vector& rho, const Vector& r) const;
  /// False when the matrix was singular in working precision.
  bool usable() const { return usable_; }

 private:
  /// Chooses the rows whose dt are unknowns: all of terms that are not separable, of the others at most so
  /// many, those of the smallest b.
  void keep_rows(const Vector& b, Index most);
  /// dy of a dt.
  Vector slopes_of(const Vector& dt) const;

  const SaddleProblem* problem_;
  std::vector<Matrix> slopes_;       ///< by term D(I - J), of separable ones the diagonal alone
  std::vector<Index> kept_;          ///< the rows whose dt are unknowns beside dxi
  Vector eliminated_;                ///< m: 1/b of the other rows, 0 of those
  Vector row_scale_, column_scale_;  ///< by which the pivots are chosen among numbers of one size
  linear_algebra::PivotedLu factor_;
  bool usable_ = true;
};

}  // namespace convex::inline composite
