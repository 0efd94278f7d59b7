#pragma once

#include <optional>
#include <vector>

#include "convex/nearest_point/multipliers/multipliers.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace mechanics {

using convex::Index;
using convex::Vector;

/// The classical hypothesis that every contact persists (Moreau 1966, section 1, (5)): all rows two-sided.
struct TwoSided {
  bool consistent = false;
  Vector acceleration;  ///< n; empty when inconsistent
  Vector multipliers;   ///< m, of least norm; empty when inconsistent
  bool unique = true;
  /// Whether it was found from its own equations; false: it is the true motion, read off the answer, which is
  /// the same where every contact persists and all rows are independent.
  bool independent = true;
  bool is_in_doubt = false;  ///< only fractions know the multipliers (`convex::Multipliers::is_in_doubt`)
};

/// Its verdict, and that of the rule which Delassus (1917) showed to be wrong: drop exactly the contacts with
/// a negative multiplier and hold the others two-sided.
struct Hypothesis {
  TwoSided two_sided;
  bool accepted = false;  ///< some two-sided multipliers are >= 0 on the one-sided rows
  std::optional<bool>
      drop_negative_is_right;   ///< none when accepted, inconsistent, or the multipliers are not unique
  std::vector<Index> negative;  ///< the one-sided rows with a negative two-sided multiplier
  std::optional<Vector> drop_negative_acceleration;  ///< what the rule gives, when it gives anything
};

/// Up to so many contacts the two-sided motion is found on its own also where the answer gives it away, for
/// the check that needs it (`reaction_from_dual`).
inline constexpr Index most_contacts_from_dual = 200;

/// The motion with every contact held, from its own equations; not solved where they are inconsistent.
convex::Solution two_sided_motion(const convex::NearestPointProblem&);

/// Judges the hypothesis against the true solution; numbers within `tolerance` of their scale count as zero.
/// limit: of fractions, as in `convex::Accuracy`.
Hypothesis hypothesis(const convex::NearestPointProblem&, const convex::Solution& truth, double tolerance,
                      double limit = 1);

}  // namespace mechanics
