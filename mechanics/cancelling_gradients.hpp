#pragma once

#include <optional>

#include "convex/nearest_point/solution.hpp"
#include "mechanics/added_row.hpp"
#include "mechanics/warning.hpp"
#include "mechanics/written_mechanism.hpp"

namespace mechanics {

/// Where weights w make gradients of constraints that persist cancel, Σ w_a u_a = 0, with w_a > 0 on
/// one-sided ones, second derivatives do not tell what F = Σ w_a f_a >= 0 asks for: of f = y³ at y = 0 with w
/// = 1, of x² + y² <= 1 and (x - 2)² + y² <= 1 at (1, 0). Warns of such sums that the answer would violate:
/// the first Taylor coefficient of F along q + q'τ + ½ q''τ² that rounding does not hide is negative, as it
/// is with the higher derivatives of q that are drawn by lot; or there is none, and motions beside this one
/// violate F. None when there are none, or more than `most_rows_looked_at` contacts persist. Row k of the
/// problem is that of contacts[k], the `added` ones come behind them; `tight`: the rows that persist.
std::optional<Warning> violated_at_higher_order(const WrittenMechanism&, const std::vector<Index>& contacts,
                                                const std::vector<AddedRow>& added,
                                                const convex::NearestPointProblem&,
                                                const std::vector<Index>& tight, const convex::Solution&,
                                                const convex::Accuracy&);

/// Looking at the gradients of so many is a matter of milliseconds.
inline constexpr std::size_t most_rows_looked_at = 200;

}  // namespace mechanics
