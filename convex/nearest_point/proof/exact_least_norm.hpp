#pragma once

#include <vector>

#include "convex/nearest_point/proof/exact_problem.hpp"

namespace convex::inline proof {

/// The shortest multipliers of the same reaction as `lambda`, which is changed into them: >= 0 where not
/// `is_free`, 0 but on the rows `basic`, which are independent, and `dependent`, which depend on them.
/// lambda, is_free: m. False, and nothing is changed, where that takes more word operations.
bool exact_least_norm(const ExactProblem&, const std::vector<Index>& basic,
                      const std::vector<Index>& dependent, const std::vector<bool>& is_free,
                      double most_words, ExactVector& lambda);

}  // namespace convex::inline proof
