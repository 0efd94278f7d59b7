#pragma once

#include "convex/atlas/cell_probability.hpp"

namespace convex::atlas {

/// Where the rule is right that holds all rows two-sided and then drops exactly those with a negative
/// multiplier. Of a cell the part on which its rows are those that the rule keeps: every kept multiplier of
/// the equations of all rows is >= 0, every dropped one negative. On the cell of all rows nothing is dropped.
/// Each row of the result is (a, b) with (a, b)·(c, 1) >= 0, c the free point: r + 1 entries.
IntegerRows kept_by_rule(const Atlas&, std::size_t cell);

/// The rule needs multipliers that are unique: independent rows.
bool rule_is_defined(const Atlas&);

/// Probabilities of what the hypothesis that every row persists, and the rule, come to.
struct RuleVerdict {
  Probability accepted;  ///< no multiplier is negative: all rows persist
  Probability right;     ///< rows are dropped, rightly
  Probability wrong;     ///< the rest of all cells, found as what is left of each
};
RuleVerdict judge_rule(const Atlas&, const CellProbability&, const std::vector<Probability>& of_cells,
                       double tolerance);

}  // namespace convex::atlas
