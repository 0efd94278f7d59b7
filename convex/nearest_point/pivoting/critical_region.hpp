#pragma once

#include <memory>
#include <vector>

#include "convex/dense/arena.hpp"
#include "convex/nearest_point/pivoting/gram_working_set.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline pivoting {

/// The affine map (z, s_S) -> (q, lambda_S) that a nearest-point problem is for as long as S is its working
/// set (a critical region of parametric quadratic programming: Bemporad, Morari, Dua and Pistikopoulos,
/// "The explicit linear quadratic regulator for constrained systems", 2002): of its n + k columns each is a
/// point corrected until it is known to twice the working precision. Columns and (z, s_S) are split each into
/// leading digits, beside the largest of a row and of all, and the rest: so few that the sums of their
/// products have no rounding (Ozaki, Ogita, Oishi and Rump, "Error-free transformations of matrix
/// multiplication", 2012).
struct CriticalRegion {
  /// Beyond so many columns the map does not stay in the second cache, and is no quicker than a solve.
  static constexpr Index most_columns = 192;
  /// Twice 53 - 31 binary digits and those of a count of columns are no more than a double has: added to so
  /// many times the largest and taken away, a number keeps these.
  static constexpr double leaves_leading = 0x1p31, beyond_leading = 0x1p-22;
  /// Up to so many rows those outside are side by side, and measured with the map.
  static constexpr Index few_rows = 32;

  /// Room for the map of the working set.
  explicit CriticalRegion(GramPoint& held);
  static Index lines(const GramPoint& held);

  Arena arena;
  GramPoint p{};                  ///< the rows S, in order, and the point that the map gives
  Index columns = 0, stride = 0;  ///< n + k, and that in whole packs
  bool has_all = false;           ///< rows are few
  /// Powers of 2: an entry of (z, s_S) times its unit is about a part of ||z||_(A⁻¹). Columns are over them.
  double *unit, *over_unit;  ///< over_unit: 1 over them
  /// By eights of rows: of each column eight leading parts and eight rests side by side, so that memory is
  /// read in order.
  double* split;
  double* gram;  ///< the products of the v_k = L⁻¹u_k over S: columns of padded(k)
  /// What an entry of (z, s_S), in its unit, may add to the error ||·||_A of q, by its size; and what
  /// rounding may in sums with the rest, by the size of the largest.
  double* error;
  double error_of_sums = 0;
  /// The scale of each of (q, lambda_S): ||·||_D of a coordinate, D the diagonal of A, the length of a row; 0
  /// beyond them. pull: minus that where either sign will do.
  double *length, *pull;
  /// Where rows are few: all of them, by eights side by side, their s, and 1 over their lengths, 0 for those
  /// of S.
  double *raw, *level, *enter;

  /// (z, s_S) in its units and split; its image, y + y_low.
  double *x, *x_leading, *x_rest, *y, *y_low;
  double remaining = 0;  ///< ||·||_A of what may be missing in q
  double rounded = 0;    ///< ||·||_D of q's part of y_low
  /// The least of (q, lambda_S), each times its scale, and where rows are few of the slacks of those not
  /// held, beyond `near_zero` of their level, over their lengths.
  double least = 0;

  double& leading(Index i, Index j) { return split[16 * (i / 8 * columns + j) + i % 8]; }
  double& rest(Index i, Index j) { return split[16 * (i / 8 * columns + j) + 8 + i % 8]; }
};

/// The region of the rows that the working set holds, which has just found them; z and s of its problem
/// change meanwhile. None where a column cannot be told to twice the working precision.
std::unique_ptr<CriticalRegion> find_critical_region(GramWorkingSet&, NearestPointProblem&);

/// The solution where nothing comes near the edge of the region: all numbers are finite then. Else false.
bool solve_in_critical_region(CriticalRegion&, const NearestPointProblem&, const Accuracy&, Solution&);

}  // namespace convex::inline pivoting
