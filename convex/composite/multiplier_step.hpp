#pragma once

#include "convex/composite/saddle_problem.hpp"

namespace convex::inline composite {

/// What a step of the method of multipliers came to.
struct MultiplierStep {
  SaddlePoint point;
  Vector gap;  ///< M ξ + b - u before entries of x were replaced: D·gap is what the step added to y
  bool minimised = false;  ///< the inner problem was solved as accurately as convergence asks for
  Index newton_steps = 0;
  Index evaluations = 0;  ///< of the inner function
};

/// One step of the proximal method of multipliers (Rockafellar 1976, section 5) from `centre`: minimises
///   ½||x - z||_W² + ½ ξ·Qξ + c·ξ + ½||w - w_0||²_ridge + sum_j env_D(scale_j f_j)(M_j ξ + b_j + y_0 / D)
/// by semismooth Newton steps with Armijo's line search; the function is strongly convex with a Lipschitz
/// gradient, so that they converge from anywhere. It stops when the distance to the minimum, as the Newton
/// decrement shows it, is this part of the step of y; a tenth is what convergence of the outer steps asks
/// for.
MultiplierStep multiplier_step(const SaddleProblem&, const SaddlePoint& centre, const Vector& D,
                               const Vector& ridge, double accuracy = 0.1);

}  // namespace convex::inline composite
