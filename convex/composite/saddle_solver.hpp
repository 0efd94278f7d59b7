#pragma once

#include "convex/composite/saddle_problem.hpp"

namespace convex::inline composite {

struct SaddleSolution {
  SaddlePoint point;
  bool infeasible = false;  ///< the terms' domains were found to be apart
  Index outer_steps = 0, newton_steps = 0, evaluations = 0;
};

/// Are the domains of the terms of f apart, so that f is +inf everywhere? The point nearest to all of them,
/// min over ξ of ½ sum_j dist(M_j ξ + b_j, dom f_j)², leaves the gaps q_j with Mᵀq = 0; they separate the
/// domains when q·b exceeds their support functions, which is held against points far out along q. False is
/// no proof that they meet.
bool domains_apart(const GraphForm& f);

/// Solves a saddle problem as far as rounding lets it; `point.residual` says how far it got. Where
/// multipliers turn out larger than D times the u they belong to (they cancel in Mᵀy), D is enlarged to
/// match, and the solution goes on from there: a miss of M ξ + b then weighs more.
/// Without x, for a value far out, D may also be so much too large that the rounding of D(t - u) hides y:
/// then it is made smaller.
///
/// D is chosen by the sizes of W and M alone, and the curvature of the terms may be of another. In a look at
/// other scales, others are tried where the steps do not come to rounding; the smallest error is taken.
SaddleSolution solve(const SaddleProblem& problem);

}  // namespace convex::inline composite
