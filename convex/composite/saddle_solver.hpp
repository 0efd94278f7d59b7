#pragma once

#include "convex/composite/saddle_problem.hpp"

namespace convex {

struct SaddleSolution {
  SaddlePoint point;
  bool infeasible = false;  ///< the terms' domains were found to be apart
  Index outer_steps = 0, newton_steps = 0, evaluations = 0;
};

/// Solves a saddle problem as far as rounding lets it; `point.residual` says how far it got. Where
/// multipliers turn out larger than D times the u they belong to (they cancel in Mᵀy), D is enlarged to
/// match, and the solution goes on from there: a miss of M ξ + b then weighs more.
SaddleSolution solve(SaddleProblem problem);

}  // namespace convex
