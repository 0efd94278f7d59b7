#pragma once

#include <optional>

#include "convex/nearest_point/proof/held_point.hpp"

namespace convex::inline proof {

/// A row that is not held and whose slack at the held point may be negative, by `below_zero` at most.
struct OpenRow {
  Index row = 0;
  double below_zero = 0;
};

/// Coefficients c of the combination U_Sᵀc of the working set that is nearest to u, as doubles find them.
Vector coefficients_on_held(const Preconditioned&, const Active&, const Vector& u);

/// How far the solution q* is from the point q_S of the working set when rows besides may be violated there:
/// rows that depend on those held, or do but for rounding.
struct OpenBound {
  double shift = 0;  ///< ||q* - q_S||_A at most
  double reach =
      0;  ///< rows whose slack no motion of this length in ||·||_A takes away were rightly left out
};

/// Proved for every problem within the radii (docs/proof.md, section 3, "Rows that depend on others"), from a
/// direction that opens all rows, found on the way; it proves that there is a solution, too. None where there
/// is no such direction, or a multiplier of a row of the working set may be 0.
std::optional<OpenBound> bound_with_open_rows(const NearestPointProblem&, const RadiiOf&,
                                              const Preconditioned&, const Active&,
                                              const std::vector<Index>& held, const HeldPoint&,
                                              const std::vector<OpenRow>&);

}  // namespace convex::inline proof
