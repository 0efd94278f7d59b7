#pragma once

#include <utility>
#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace mechanics {

/// A row that some numbers within the radii of the rows make a combination of two-sided ones: u_row =
/// Σ weight u_a over the pairs (a, weight) of `others`, which are independent.
struct DependentRow {
  convex::Index row;
  std::vector<std::pair<convex::Index, double>> others;
};

/// Which rows are asked for.
enum class RowsCompared { two_sided, all };

/// Those before in the list of two-sided rows are what rows are combinations of. None where the data have no
/// radii, or there are more than `most_rows_compared`.
std::vector<DependentRow> dependent_rows(const convex::NearestPointProblem&, RowsCompared);

/// Comparing so many is a matter of milliseconds.
inline constexpr std::size_t most_rows_compared = 400;

}  // namespace mechanics
