#pragma once

#include "convex/composite/saddle_problem.hpp"

namespace convex::inline composite {

/// How far x of a point is from the solution, in ||·||_W, rounding included.
struct SaddleError {
  double bound = 0;
  double rounding = 0;  ///< the part that rounding alone makes up
  double of_value = 0;  ///< an estimate of the error of the minimum: of second order in the residuals
  bool proven = false;  ///< by firm nonexpansiveness; else estimated (see `prox`)
};

/// Points on the way are compared by the system that Newton's method works with. The answer that is told is
/// held against `SensitivitySystem`, too: where a multiplier vanishes the other hides how far a w may be off.
enum class ErrorOf { point, answer };

SaddleError saddle_error(const SaddleProblem&, const SaddlePoint&, ErrorOf of = ErrorOf::point);

}  // namespace convex::inline composite
