#pragma once

#include <vector>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline dual_active_set {

/// What the Gram matrix of whitened rows tells of a problem: the answer, if it is one; else the one-sided
/// rows of the working set when it stopped in doubt.
struct GramOutcome {
  bool is_answer = false;
  Solution solution;
  std::vector<Index> rows;
};

/// The active-set method on the Gram matrix of the whitened rows, for dense U: principal pivoting by blocks
/// (Júdice and Pires 1994; Kunisch and Rendl 2003), the dual method of Goldfarb and Idnani (1983) where that
/// does not settle, and corrections with residuals of the original data in twice the working precision. In
/// doubt where rows of the working set are nearly dependent, or a sign cannot be told from rounding. An
/// infeasible answer has its proof. The data are checked. guess: rows thought to be active.
GramOutcome solve_by_gram_matrix(const NearestPointProblem&, const Accuracy&,
                                 const std::vector<Index>& guess);

/// Whether that way is open to a problem of that size and kind.
bool has_gram_matrix(const NearestPointProblem&);

/// The same problem with its diagonal metric as a dense one, which the kernels are made for.
NearestPointProblem with_dense_metric(NearestPointProblem);

}  // namespace convex::inline dual_active_set
