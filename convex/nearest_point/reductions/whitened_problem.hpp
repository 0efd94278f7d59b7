#pragma once

#include "convex/nearest_point/problem.hpp"

namespace convex::inline reductions {

/// The problem in whitened terms, rows of length 1 and largest bound 1, for methods that work on dense data:
/// minimise ½|d|² over v_a·d >= b_a, with equality for the free ones, where d = (w - w_free)/unit. Its dual
/// is to minimise ½|V y|² - b·y over y >= 0 (y free on two-sided rows), and d = V y.
struct WhitenedProblem {
  explicit WhitenedProblem(const NearestPointProblem&);

  Matrix V;                 ///< n×k, columns v_a/|v_a|; rows of U that are 0 are left out
  Vector b;                 ///< k
  std::vector<Index> rows;  ///< the row of U of each column
  std::vector<bool> free;   ///< whether it is two-sided
  double unit = 1;          ///< max |s_a - v_a·w_free| / |v_a|
  Vector length;            ///< |v_a|

  Index size() const { return b.size(); }
  bool is_free(Index a) const { return free[at(a)]; }
  std::vector<Index> free_columns() const;
  /// lambda of the problem from y: m.
  Vector multipliers(const NearestPointProblem&, const Vector& y) const;
  /// Farkas weights of the problem from weights of the columns.
  Vector weights(const NearestPointProblem&, const Vector& y) const;
};

}  // namespace convex::inline reductions
