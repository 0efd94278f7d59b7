#pragma once

#include <string_view>

#include "convex/nearest_point/optimality/refinement.hpp"

namespace convex::inline dual_active_set {

/// Decides without rounding whether the point q of the rows S keeps the rows outside S that it touches as far
/// as doubles tell: those with slack <= 0, and two-sided ones. Either q itself, in doubles, is on the rows S
/// and keeps them, or each of them is a sum of rows of S and asks for no more than they do. slack: m; where
/// all are kept, theirs becomes 0, or what it is, and nothing is returned; else what stays open
/// (`open_question`); of `zero_slacks`, all are kept. Where the data have radii, every such row stays open.
std::string_view decide_degenerate_rows(WorkingSet& set, const RefinedPoint& refined, const Vector& row_scale,
                                        Vector& slack);

}  // namespace convex::inline dual_active_set
