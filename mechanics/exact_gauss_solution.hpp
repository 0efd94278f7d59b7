#pragma once

#include "convex/nearest_point/proof/exact_multipliers.hpp"
#include "mechanics/gauss_solution.hpp"

namespace mechanics {

/// The answer to Gauss' problem in fractions: what `GaussSolution` says, with no tolerance anywhere.
struct ExactGaussSolution {
  convex::ExactSolution primal;
  convex::ExactMultipliers multipliers;
  convex::ExactVector reaction;  ///< R = A q'' - z: n
  convex::Fraction gauss;
  GaussSolution rounded;  ///< all of it as the nearest doubles
};

/// `problem`: the same in doubles, which guess the active rows. Throws InvalidInput as
/// `convex::exact_problem` does.
ExactGaussSolution solve_exactly(const convex::ExactProblem& exact,
                                 const convex::NearestPointProblem& problem, const GaussOptions&);

/// The hypothesis that every contact persists, and the rule of dropping negative multipliers, judged in
/// fractions against the true solution.
Hypothesis exact_hypothesis(const convex::ExactProblem&, const convex::ExactSolution& truth);

}  // namespace mechanics
