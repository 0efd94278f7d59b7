#pragma once

#include "convex/laws/check.hpp"
#include "convex/nearest_point/problem.hpp"
#include "mechanics/gauss_solution.hpp"

namespace mechanics {

/// R, as it is told, is Σ lambda_a u_a or A q'' - z, coordinate by coordinate and but for rounding. The other
/// laws are of A q'' - z and of Σ lambda_a u_a: at rest none of them sees R.
convex::Check reaction_law(const convex::NearestPointProblem&, const GaussSolution&);

}  // namespace mechanics
