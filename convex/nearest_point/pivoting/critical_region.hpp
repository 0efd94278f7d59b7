#pragma once

#include "convex/nearest_point/pivoting/small_tableau.hpp"

namespace convex::inline pivoting {

/// The affine map (z, s_W) -> (q, lambda_W) that a nearest-point problem is for as long as W is its working
/// set (a critical region of parametric quadratic programming: Bemporad, Morari, Dua and Pistikopoulos,
/// "The explicit linear quadratic regulator for constrained systems", 2002): of its n + k columns each is a
/// point corrected until it is known to twice the working precision. Columns and (z, s_W) are split each into
/// leading digits, beside the largest of a row and of all, and the rest: so few that the sums of their
/// products have no rounding (Ozaki, Ogita, Oishi and Rump, "Error-free transformations of matrix
/// multiplication", 2012).
struct CriticalRegion {
  static constexpr Index most = 2 * SmallTableau::most_coordinates;
  /// Twice 53 - 30 binary digits and those of a count of columns are no more than a double has: added to so
  /// many times the largest and taken away, a number keeps these.
  static constexpr double leaves_leading = 0x1p30, beyond_leading = 0x1p-23;

  Index columns = 0, stride = 0;               ///< n + k, and that in whole packs
  Index rows[SmallTableau::most_coordinates];  ///< W, in order
  /// Powers of 2: an entry of (z, s_W) times its unit is about a part of ||z||_(A⁻¹). Columns are over them.
  alignas(64) double unit[most];
  /// By eights of rows: of each column eight leading parts and eight rests side by side, so that memory is
  /// read in order.
  alignas(64) double split[2 * most * most];
  alignas(64) double balance[most * SmallTableau::most_coordinates];  ///< columns of A, then rows of U_W
  /// What an entry of (z, s_W), in its unit, may add to the error ||·||_A of q, by its size; and what
  /// rounding may in sums with the rest, by the size of the largest.
  alignas(64) double error[most];
  double error_of_sums = 0;
  /// The scale of each of (q, lambda_W): ||·||_D of a coordinate, D the diagonal of A, the length of a row; 0
  /// beyond them. pull: minus that where either sign will do.
  alignas(64) double length[most], pull[most];

  /// (z, s_W) in its units and split; its image, y + y_low.
  alignas(64) double x[most], x_leading[most], x_rest[most], y[most], y_low[most];
  double remaining = 0;  ///< ||·||_A of what may be missing in q
  double rounded = 0;    ///< ||·||_D of q's part of y_low
  /// The least of (q, lambda_W), each times its scale, and where rows are few of the slacks of those not
  /// held, beyond `near_zero` of their level, over their lengths.
  double least = 0;
  bool has_all = false;  ///< the slacks of all rows outside are in `least`

  double& leading(Index i, Index j) { return split[16 * (i / 8 * columns + j) + i % 8]; }
  double& rest(Index i, Index j) { return split[16 * (i / 8 * columns + j) + 8 + i % 8]; }
};

}  // namespace convex::inline pivoting
