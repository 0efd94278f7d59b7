#pragma once

#include <optional>
#include <string_view>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// What a method has found, to be judged.
struct Candidate {
  std::string_view method;
  Vector q;       ///< n; may be empty when lambda is there: then A⁻¹(z + Uᵀlambda) is meant
  Vector lambda;  ///< m; negative ones on one-sided rows count as 0
  Vector farkas;  ///< m, or empty: weights that the method holds for a proof that there is no solution
  Index steps = 0;
  bool finished = true;    ///< false when the method ended at its limit
  bool may_polish = true;  ///< whether the answer may be the point of the rows that it shows to be active
};

/// Judges a candidate; all methods but active-set, which judges itself by the same measures, end here.
/// Residuals are those of `residuals`. The bound on ||q - q*||_A, q* the solution, is the second one of
/// these, or the first where no rows can be held.
///
/// From the candidate alone: `bound_by_gap`, a root.
///
/// From the working set: the point p of the active rows (`active_set_near`), refined in twice the working
/// precision, meets all conditions exactly but for what refinement left, multipliers negative by rounding,
/// and rows contradicted by rounding; in each of these ||p - q*|| is linear. Then ||q - q*|| <= ||q - p|| +
/// ||p - q*||.
///
/// When the candidate may be polished, p is the answer, marked as polished, as long as it is within the
/// tolerance. `solved`: the bound is at most tolerance max(1, ||q||_A); otherwise `inaccurate`, or `gave_up`
/// when not finished. `infeasible`: weights were found, the candidate's own or a circuit among them, that are
/// proved without rounding, or, where the rows have radii, by the active set on the rows with weights.
Solution crossover(const NearestPointProblem&, const Candidate&, const Accuracy&);

/// Validates the problem. The answer when none of the rows matters or one is a contradiction by itself
/// (u_a = 0): nothing is left to a method.
std::optional<Solution> without_a_method(const NearestPointProblem&, std::string_view method,
                                         const Accuracy&);

/// Up to so many rows, methods that work on a matrix of rows by rows are affordable.
inline constexpr Index most_dense_rows = 3000;

}  // namespace convex::inline algorithms
