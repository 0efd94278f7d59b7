#pragma once

#include <vector>

#include "convex/nearest_point/active_set/dependence.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline multiplier_sets {

/// Whether lambda pulls as the solution's multipliers do, or as its point asks for, Aq - z, within the
/// tolerance: the solution's multipliers tell that in few digits where they are far larger.
bool is_same_reaction(const NearestPointProblem&, const Solution&, const Vector& lambda, double tolerance);

/// Of the multipliers of a solution, which is a vertex of their polyhedron, those of least norm over groups
/// of rows that depend on each other: with lambda = lambda_0 + N mu, N the null vectors e_p - Σ T(k, p) e_k,
/// the nearest point to 0 in {mu : lambda >= 0 on one-sided rows}. lambda: in, those of the solution; what
/// they miss of its reaction is put on rows of each group and brought to least norm again, as far as it gets
/// less. False where they do not pull as the solution's do (`is_same_reaction`).
bool least_norm(const NearestPointProblem&, const Solution&, std::vector<Dependence> groups,
                const std::vector<bool>& is_free, double tolerance, Vector& lambda);

}  // namespace convex::inline multiplier_sets
