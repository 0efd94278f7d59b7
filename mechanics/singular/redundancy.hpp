#pragma once

#include "mechanics/expression/constraint_series.hpp"

namespace mechanics::inline singular_states {

using convex::Index;
using convex::Vector;

/// Whether a constraint holds by itself wherever the others of its group do: f_main = 0 at points near the
/// state that are chosen at random and moved onto {f_a = 0, a in `others`}, whose gradients are independent,
/// by Newton's method. An analytic f that is 0 at such a point is 0 on the whole branch, but for an accident
/// of probability 0. None where no such point was reached.
/// `main`, `others`: positions among the constraints of the series; `columns`: the coordinates to be moved.
std::optional<bool> is_redundant(const expression::ConstraintSeries& series, const State& state,
                                 const std::vector<Index>& columns, Index main,
                                 const std::vector<Index>& others);

}  // namespace mechanics::inline singular_states
