#pragma once

#include <limits>

#include "convex/nearest_point/proof/exact_problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline proof {

/// The solution in fractions: q: n; lambda: m; slack_a = u_a·q - s_a. When infeasible, `farkas` (m) holds
/// integer weights without a common factor, w >= 0 on one-sided rows, with wᵀU = 0 and w·s > 0, and the rest
/// is empty.
struct ExactSolution {
  Status status = Status::solved;
  ExactVector q, lambda;
  std::vector<Fraction> slack;
  std::vector<Index> basis;  ///< independent rows, tight, that hold all multipliers
  IntegerVector farkas;
  Index steps = 0;             ///< rows taken in or dropped after the guess
  double word_operations = 0;  ///< an estimate of the work, from the sizes of the numbers that came up
};

/// Solves the problem in fractions. `guess`: rows thought to be active; where they are, the answer costs one
/// linear system and its signs. Else rows are dropped until multipliers have their signs, and violated rows
/// are taken in one at a time by the dual method of Goldfarb and Idnani (1983), all in fractions: finite,
/// without assumptions on the rows. It gives up when the next linear system would take it beyond
/// so many word operations.
ExactSolution exact_active_set(const ExactProblem&, const std::vector<Index>& guess,
                               double most_words = std::numeric_limits<double>::infinity());

/// An estimate of the word operations of one linear system with `held` rows, the longest, and of all slacks
/// at its solution; from the sizes of the numbers alone.
double word_operations(const ExactProblem&, std::size_t held);

/// Whether wᵀU = 0, w·s > 0 and w >= 0 on one-sided rows, in integers. w: m.
bool proves_infeasibility(const ExactProblem&, const IntegerVector& w);

}  // namespace convex::inline proof
