#pragma once

#include "convex/nearest_point/proof/uncertain_problem.hpp"

namespace mechanics {

using convex::Index;

/// A problem with radii in which nothing is left to them of what rows are to each other.
struct SettledMiddle {
  convex::ExactProblem problem;
  std::vector<Index> dependent;  ///< rows that depend on others within the radii, and in `problem` exactly
};

/// The middle of an uncertain problem, its rows moved within the radii: a row that may be a combination of
/// others becomes one, its bound too where it may be that of theirs. Rows are compared in order, two-sided
/// ones first, then those of `first`. Of ‖·‖ in the diagonal of A, u_a = Σ c_k u_k + rest with the least
/// rest; where u_a can be a combination, ‖rest‖ <= ‖û_a‖ + Σ |c_k| ‖û_k‖ to first order in the radii û.
SettledMiddle settled_middle(const convex::UncertainProblem&, const std::vector<Index>& first);

}  // namespace mechanics
