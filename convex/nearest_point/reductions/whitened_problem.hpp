#pragma once

#include "convex/nearest_point/reductions/scaled_problem.hpp"

namespace convex::inline reductions {

/// The problem in whitened terms, rows of length 1 and largest bound 1, for methods that work on dense data:
/// minimise ½|d|² over v_a·d >= b_a, with equality for the free ones, where d = (w - w_free)/unit. Its dual
/// is to minimise ½|V y|² - b·y over y >= 0 (y free on two-sided rows), and d = V y.
struct WhitenedProblem : ScaledRows {
  explicit WhitenedProblem(const NearestPointProblem&);

  Matrix V;  ///< n×k, columns v_a/|v_a|
  Vector b;  ///< k; unit: max |s_a - v_a·w_free| / |v_a|

  Index size() const { return b.size(); }
  bool is_free(Index a) const { return two_sided[at(a)]; }
  std::vector<Index> free_columns() const;
};

/// The linear complementarity problem of a nearest-point problem: w = M y - b >= 0, y >= 0, y·w = 0 over the
/// one-sided columns of `WhitenedProblem`, M = VᵀV after the free columns have been projected out by an
/// orthogonal factor.
struct Complementarity {
  explicit Complementarity(const WhitenedProblem&);

  Matrix V;                    ///< n×k, the one-sided columns at right angles to the free ones
  Matrix M;                    ///< k×k
  Vector b;                    ///< k
  std::vector<Index> columns;  ///< of WhitenedProblem

  /// Multipliers of all columns from those of the one-sided ones.
  Vector with_free(const WhitenedProblem&, const Vector& y) const;
};

}  // namespace convex::inline reductions
