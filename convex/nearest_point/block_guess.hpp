#pragma once

#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace convex {

/// Rows thought to be active, with F⁻¹u_a of each as a column.
struct GuessedRows {
  std::vector<Index> rows;
  Matrix whitened;
  bool settled = false;  ///< no row was found wrong at the point that they define
};

/// A guess at the active rows, without the two-sided ones, by principal pivoting in blocks (Kunisch and Rendl
/// 2003; Júdice and Pires 1994): all violated rows come in and all rows with a negative multiplier go out at
/// once, for as long as that reduces their number. It works on the Gram matrix of the whitened rows, which
/// squares their condition: good enough for a guess, never used for an answer. w_free = F⁻¹z; row_scale:
/// positive lengths of the rows that violations are compared by; first: rows to begin with, or empty to begin
/// with those that are violated where `slack`, Uq - s at the point that keeps the two-sided rows alone, says
/// so.
GuessedRows guess_by_blocks(const NearestPointProblem&, const Vector& w_free, const Vector& row_scale,
                            std::vector<Index> first, Vector slack);

}  // namespace convex
