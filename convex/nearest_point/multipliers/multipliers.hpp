#pragma once

#include <optional>
#include <vector>

#include "convex/interval.hpp"
#include "convex/nearest_point/active_set/dependence.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline multiplier_sets {

/// All multipliers of a solved problem. They form the polyhedron {lambda : Uᵀlambda = R, lambda_a >= 0 on
/// one-sided rows, lambda_a = 0 off the tight rows}, R = Aq - z being unique even where they are not.
struct Multipliers {
  bool unique = true;
  Vector least_norm;  ///< of least Euclidean norm, but where these are not found: m
  bool is_least_norm = true;
  /// The m intervals of the multipliers over all dual optima; none when not asked for, or when rounding keeps
  /// one from being found.
  std::optional<std::vector<Interval>> ranges;
  /// A basis of {mu : Uᵀmu = 0} over the tight rows; none when they are too many for a dense factor.
  std::optional<std::vector<NullVector>> null_space;
  /// Whether only fractions know the multipliers (`exact_multipliers`): where doubles count rows as dependent
  /// that are independent as they stand, or those that others depend on are nearly dependent.
  bool is_in_doubt = false;
  double range_seconds = 0;  ///< what the ranges took, which nobody needs to solve a problem
  std::vector<Index> tight;  ///< rows with u_a·q = s_a within the tolerance, in order
};

/// Rows with |u_a·q - s_a| <= tolerance (|s_a| + Σ_i |u_ai q_i|), or within what the error bound of q, up to
/// the tolerance of ||q||_A, and the rounding of the data make of a slack; and the two-sided ones.
std::vector<Index> tight_rows(const NearestPointProblem&, const Solution&, double tolerance);

/// The dual optima of a solved (or inaccurately solved) problem. `want_ranges`: two linear programs for every
/// row that depends on others or is needed for them, each from where the last one ended, so leave it out for
/// thousands of rows; uniqueness is then found all the same.
Multipliers multipliers(const NearestPointProblem&, const Solution&, double tolerance, bool want_ranges);

}  // namespace convex::inline multiplier_sets
