#pragma once

#include <optional>
#include <string_view>

#include "convex/double_double.hpp"
#include "convex/nearest_point/problem.hpp"

namespace convex::inline algorithms {

/// The point at which the rows of a set S hold with equality, as in `RefinedPoint`, for the set that a given
/// q and lambda show to be active.
struct HeldRows {
  std::vector<Index> rows;  ///< S; independent when n·m is small enough for a dense factor
  DoubleDoubleVector q;     ///< n
  Vector lambda;            ///< m; 0 off S. Negative ones on one-sided rows are smaller than `noise`
  Vector slack;             ///< Uq - s: m; 0 on S and where refinement cannot tell it from 0
  double remaining = 0;     ///< an estimate of ||q - q_S||_A, q_S the exact point of S
  double inverse_norm =
      0;  ///< an estimate of 1 / (smallest singular value of the whitened rows of S, each of length 1)
  double contradiction = 0;  ///< how far beyond the worst row off S that S contradicts by rounding alone
  std::string_view undecided = {};  ///< what doubles leave open about rows off S
};

/// What came of holding the rows that look active.
struct Holding {
  std::optional<HeldRows> held;
  Vector farkas;  ///< m, or empty: weights of rows that turned out to contradict each other; not verified
};

/// Row a counts as active when lambda_a ||u_a|| > (u_a·q - s_a) / ||u_a||, both sides being lengths in the
/// metric. Of dependent active rows a basis with multipliers >= 0 is taken (Carathéodory 1911). Rows whose
/// multiplier turns out negative go, rows violated at the new point come in, no more than `most_changes` in
/// all; nothing is held when that does not do, or when refinement does not converge. row_scale:
/// ||u_a||_(D⁻¹), D the diagonal of A: m.
Holding hold_active_rows(const NearestPointProblem&, const Vector& q, const Vector& lambda,
                         const Vector& row_scale, Index most_changes);

/// The same with sparse factors, for problems that dense ones are too large for: dependent rows stay in S
/// (`refine_rows`), and rows of a wrong sign change sides all at once, at most three times.
Holding hold_active_rows_sparse(const NearestPointProblem&, const Vector& q, const Vector& lambda,
                                const Vector& row_scale);

}  // namespace convex::inline algorithms
