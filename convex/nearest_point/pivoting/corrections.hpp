#pragma once

#include "convex/nearest_point/optimality/refinement.hpp"
#include "convex/nearest_point/pivoting/gram_point.hpp"

namespace convex::inline pivoting {

/// What corrections with residuals in twice the working precision make of the point of some rows of the
/// working set: how they converge, what of q and lambda is 0 as far as they tell, and the bound that is left.
class Corrections {
 public:
  /// Notes one (`GramPoint::step`, `change`). False when corrections shrink too slowly.
  bool note(const GramPoint&);

  /// Takes what cancels in q + q_low and lambda for 0; or false, if `more`, when another correction may tell
  /// some of it from 0. `wrong` becomes the size of a negative multiplier, if there is one.
  bool take_noise_for_zero(GramPoint&, bool more);

  /// What may be missing in the slack of a row of this length.
  double missing_slack(double row_scale) const { return margin * row_scale * (remaining + dropped); }

  double remaining = 0;  ///< an estimate of what is still missing, ||·||_A
  double dropped = 0;    ///< at least ||·||_A of what cancelled and was taken for 0
  double rounding = 0;   ///< of q to doubles
  double bound = 0;
  double wrong = 0;  ///< the largest wrong multiplier, times its length, or slack, over it
  double scale = 0;  ///< max(||q||_A, ||z||_(A⁻¹))

 private:
  /// What is missing in a point may show this many times as large in a slack: ||u_a||_(D⁻¹), D the diagonal
  /// of A, stands for the row's length, and what is missing is an estimate.
  static constexpr double margin = 16;

  double floor_of_residuals() const;

  double step_ = 0, likely_ = 0, factor_condition_ = 1, gram_condition_ = 0;
  int count_ = 0;
  bool is_fresh_ = true;
};

/// Rows whose signs the first correction tells have this part of their squared length outside the span of
/// those held, so that they may come in.
inline constexpr double least_independent = 1e-6;

}  // namespace convex::inline pivoting
