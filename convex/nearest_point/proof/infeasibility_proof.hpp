#pragma once

#include <optional>

#include "convex/exact/integer.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/proof/certificate.hpp"

namespace convex::inline proof {

/// A proof that no q satisfies the rows of a problem, its doubles taken at their exact values.
struct InfeasibilityProof {
  ProofLevel level = ProofLevel::none;
  Vector farkas;          ///< m; rounded
  IntegerVector weights;  ///< m; exact, when the level is
};

/// From weights w, wᵀU = 0 and w·s > 0 up to rounding: the rows with weights and nothing else are looked at,
/// so that it takes as long as these are many, not as the problem is large. Their one dependence is found in
/// fractions while they are at most `most_exact_rows`; else, when they are one more than the coordinates that
/// they touch, it exists whatever the roundings, and its signs are proved in doubles. None where neither
/// applies. in_fractions = false: whole numbers and doubles are all that is tried.
std::optional<InfeasibilityProof> infeasibility_proof(const NearestPointProblem&, const Vector& w,
                                                      bool in_fractions = true);

inline constexpr Index most_exact_rows = 250;

}  // namespace convex::inline proof
