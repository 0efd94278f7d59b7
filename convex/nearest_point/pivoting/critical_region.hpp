#pragma once

#include "convex/nearest_point/pivoting/small_tableau.hpp"

namespace convex::inline pivoting {

/// The affine map (z, s_W) -> (q, lambda_W) that a nearest-point problem is for as long as W is its working
/// set (a critical region of parametric quadratic programming: Bemporad, Morari, Dua and Pistikopoulos,
/// "The explicit linear quadratic regulator for constrained systems", 2002), to twice the working precision:
/// of its n + k columns each is a point corrected until it is known.
struct CriticalRegion {
  static constexpr Index most = 2 * SmallTableau::most_coordinates;

  Index columns = 0, stride = 0;               ///< n + k, and that in whole packs
  Index rows[SmallTableau::most_coordinates];  ///< W, in order
  alignas(64) double high[most * most], low[most * most];
  alignas(64) double balance[most * SmallTableau::most_coordinates];  ///< columns of A, then rows of U_W
  /// What an entry of (z, s_W) may add to the error ||·||_A of q, by its size.
  alignas(64) double error[most];
  /// The scale of each of (q, lambda_W): ||·||_D of a coordinate, D the diagonal of A, the length of a row; 0
  /// beyond them. pull: minus that where either sign will do.
  alignas(64) double length[most], pull[most];

  alignas(64) double x[most], y[most], y_low[most];  ///< (z, s_W) and its image, y + y_low
  double remaining = 0;                              ///< ||·||_A of what may be missing in q
  double rounded = 0;                                ///< ||·||_D of q's part of y_low
  /// The least of (q, lambda_W), each times its scale, and where rows are few of the slacks of those not
  /// held, beyond `near_zero` of their level, over their lengths.
  double least = 0;
  bool has_all = false;  ///< the slacks of all rows outside are in `least`
};

}  // namespace convex::inline pivoting
