#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "convex/nearest_point/active_set/gram_method.hpp"

/// How the tests of `solve_by_gram_matrix` measure its answers.
namespace gram_matrix {

inline constexpr double few_roundings = 4e-15;

inline double scale(const convex::NearestPointProblem& problem, const convex::Vector& x) {
  return std::max({problem.A.norm(x), problem.A.dual_norm(problem.z), 1e-300});
}

/// The answer that the Gram matrix gives, where it gives one.
inline std::optional<convex::Solution> answer(const convex::NearestPointProblem& problem,
                                              const std::vector<convex::Index>& guess = {}) {
  convex::GramOutcome found = convex::solve_by_gram_matrix(problem, {}, guess);
  return found.is_answer ? std::optional(std::move(found.solution)) : std::nullopt;
}

}  // namespace gram_matrix
