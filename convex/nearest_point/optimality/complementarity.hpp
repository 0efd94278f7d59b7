#pragma once

#include "convex/nearest_point/reductions/whitened_problem.hpp"

namespace convex::inline optimality {

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

}  // namespace convex::inline optimality
