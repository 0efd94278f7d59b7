#pragma once

#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace convex::inline isotonic {

/// Coordinates strung up by one-sided rows c (q_j - q_i) >= s, c > 0, each coordinate with at most one such
/// row above and one below; a row c q_i >= s, c > 0, under the first of a string is its floor. Strings stand
/// one after the other, each from its first coordinate upwards.
struct Strings {
  std::vector<int> coordinate;  ///< n, in the order of the strings
  std::vector<int> row;         ///< n: the row below each of these; of a first one its floor, -1 for none
  std::vector<int> first;       ///< where each string begins, and n
  std::vector<Index> border;    ///< rows that fit into no string, increasing
  Index count() const { return static_cast<Index>(first.size()) - 1; }
};

/// O(n + entries), for a diagonal A and sparse rows; `count` = 0 when A or U is of another kind, or as soon
/// as more than `most_border` rows do not fit.
Strings find_strings(const NearestPointProblem&, Index most_border);

}  // namespace convex::inline isotonic
