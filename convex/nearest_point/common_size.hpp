#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// A problem with rows of length about 1 and the largest of A, z and of what rows ask for about 1, for
/// numbers whose squares are not doubles: A = mass A', z = mass unit z', u_a = row_unit_a u'_a, s_a =
/// row_unit_a unit s'_a; all units are powers of two, so that nothing is rounded. Rows that are not there ask
/// for so little that no motion of that size comes near them.
struct CommonSize {
  explicit CommonSize(const NearestPointProblem& original);

  NearestPointProblem problem;
  std::vector<Index> rows;  ///< of the original
  Vector row_unit;          ///< of these
  double mass = 1, unit = 1;
  bool is_ordinary = true;  ///< whether now all numbers that count have squares that are doubles

  /// The solution of the original from that of `problem`; not solved, and no contradiction, where numbers are
  /// still out of range, or a row left out may matter.
  Solution restored(const NearestPointProblem& original, Solution, const Accuracy&) const;
};

/// Whether squares and products of the numbers of a problem are doubles.
bool has_ordinary_numbers(const NearestPointProblem&);

/// method(problem, accuracy), on the problem of common size where numbers of this one may be so large or
/// small that their squares and products are none.
Solution in_common_size(const NearestPointProblem&, const Accuracy&,
                        Solution (*method)(const NearestPointProblem&, const Accuracy&));

/// Whether the numbers of a solution are so large that their squares are no doubles, or so small that those
/// of what rounding left of them are none: its bound tells nothing.
bool is_beyond_squares(const NearestPointProblem&, const Solution&);
/// method(problem, accuracy) on the problem of common size, in place of a solution that is beyond squares;
/// one that fractions solved stays where that does not solve.
void take_own_size(const NearestPointProblem&, const Accuracy&,
                   Solution (*method)(const NearestPointProblem&, const Accuracy&), Solution&);

}  // namespace convex
