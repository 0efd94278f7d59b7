#pragma once

#include "convex/nearest_point/problem.hpp"

namespace convex::inline reductions {

/// A as a sparse matrix, whatever it is stored as.
SparseMatrix sparse_gram(const Metric& A);

/// A sparse nearest-point problem in units in which numbers are near 1: coordinates in which the diagonal of
/// A is 1, rows of length 1, z and s in units of the largest. q = unit coordinate ∘ q_scaled, and
/// lambda = unit multiplier ∘ lambda_scaled.
struct BalancedProblem {
  SparseMatrix A;  ///< n×n, unit diagonal, both triangles
  SparseRows U;    ///< m×n
  Vector z, s;
  std::vector<bool> two_sided;  ///< m
  Vector coordinate, multiplier, linear,
      bound;  ///< units: n, m, n, m; z = linear ∘ z_scaled, s = bound ∘ s_scaled
};

/// The data are checked; A may be of any kind.
BalancedProblem balanced_problem(const NearestPointProblem&);

}  // namespace convex::inline reductions
