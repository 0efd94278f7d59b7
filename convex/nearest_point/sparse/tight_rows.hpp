#pragma once

#include <string_view>

#include "convex/nearest_point/sparse/row_system.hpp"
#include "convex/nearest_point/sparse/sparse_refinement.hpp"

namespace convex::inline sparse {

/// Rows held with equality and rows besides that the point touches for all that twice the working precision
/// tells, both increasing.
struct TightRows {
  const NearestPointProblem& problem;
  const BalancedProblem& scaled;
  RowSystem& system;  ///< factored with the weights of the last corrections; may be factored anew
  const std::vector<Index>& held;
  const std::vector<Index>& degenerate;
};

/// Whether the rows of the working set hold firmly, so that what corrections leave tells how far q is from
/// where they hold, and those degenerate have a slack of 0, put right in `slack` where it has a sign: what is
/// open
/// (`open_question`) where that cannot be told, else nothing. What depends on what, and with which bound, is
/// decided without rounding; with radii, what is 0 within them counts as 0. limit: as in `Accuracy`.
std::string_view decide_tight_rows(const TightRows&, const SparsePoint& point, const Vector& weight,
                                   double limit, Vector& slack);

}  // namespace convex::inline sparse
