#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// Lemke's complementary pivoting (1965) with the lexicographic ratio test, on the linear complementarity
/// problem w = M y - b, M = VᵀV of the whitened rows with the two-sided ones projected out. Ending on a ray,
/// it hands the ray's multipliers to `crossover` as a proof that there is no solution, and solves proximal
/// problems with M + ridge I (Rockafellar 1976) when they are none.
Solution lemke(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
