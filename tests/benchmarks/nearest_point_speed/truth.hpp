#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"
#include "families.hpp"

namespace speed {

/// As the library takes it: A, U, z and s are copied.
convex::NearestPointProblem assembled(const DenseProblem&);

/// The answer in fractions, rounded: q, and an independent set of rows that it rests on; or, where there is
/// none, the rows that contradict each other.
struct Truth {
  bool feasible = false;
  Vector q;
  std::vector<Index> rows;
};

/// Throws std::logic_error when the planted answer is another one.
Truth truth_of(const DenseProblem&);

/// ||q - q*||_A over the larger of ||q*||_A and ||z||_(A⁻¹).
double error_of(const DenseProblem&, const Truth&, const Vector& q);

/// A peer's answer is right to this, ours too.
inline constexpr double right_to = 1e-9;

/// Ours: solved and right, or infeasible with weights w >= 0, wᵀU = 0 but for rounding, w·s > 0 beyond it.
bool is_right(const DenseProblem&, const Truth&, const convex::Solution&);

}  // namespace speed
