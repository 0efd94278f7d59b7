#pragma once

#include <algorithm>

#include "convex/nearest_point/problem.hpp"

namespace oracles {

/// "A few 1e-15" of docs/methods/figures.md.
inline constexpr double few_roundings = 4e-15;

/// What errors of q are measured against: max(||q||_A, ||z||_(A⁻¹)), positive.
inline double scale(const convex::NearestPointProblem& problem, const convex::Vector& q) {
  return std::max({problem.A.norm(q), problem.A.dual_norm(problem.z), 1e-300});
}

}  // namespace oracles
