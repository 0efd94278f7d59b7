#pragma once

#include "convex/composite/saddle_problem.hpp"

namespace convex::inline composite {

/// Newton's method on the optimality conditions in the unknowns (ξ, t), for one x = u the normal map of
/// Robinson (1992): steps are kept while they divide `residual`; quadratic where the Jacobian at the solution
/// is regular. Returns the last point that was kept; the problem's own D is used throughout.
struct Polished {
  SaddlePoint point;
  Index evaluations = 0;  ///< of the conditions
};
Polished newton_polish(const SaddleProblem&, const SaddlePoint& from);

/// Newton's method is regularised with this part of D: its step is that of the method of multipliers with a D
/// larger by 1/polish_theta, so that dependent rows do no harm. Far from the solution the part is larger.
inline constexpr double polish_theta = 1e-9, far_theta = 1e-2;

/// The same for w: times R.
inline constexpr double polish_ridge = 1e-10;

}  // namespace convex::inline composite
