#pragma once

#include "convex/laws/check.hpp"
#include "mechanics/gauss_solution.hpp"

namespace mechanics {

/// The decomposition theorem on Moreau's problem (1966, sections 3 to 5): x = A q'', y = -R, in the metric
/// (x|y) = x·A⁻¹y, f the indicator of C, g its support function.
/// - x is in C, lambda >= 0, lambda_a (u_a·q'' - s_a) = 0, A q'' = z + Σ lambda_a u_a;
/// - z = x + y, x from the primal and y from the dual alone: by section 5's cone where x_0 exists, else by
///   least distance;
/// - section 5: no other force of the contacts is as near to the two-sided reaction A q_0 - z as R;
/// - conjugacy: R·q'' = lambda·s, that is f(x) + g(y) = (x|y);
/// - uniqueness: no other acceleration that the contacts allow has as small a G, G(q) - G(q'') >= ½||q -
///   q''||².
/// Of an infeasible problem, that the Farkas weights prove it. Bounds come from the solution's own error
/// bound, the condition of the active rows and rounding.
convex::LawReport gauss_laws(const convex::NearestPointProblem&, const GaussSolution&,
                             const GaussOptions& = {});

/// What the error bound and rounding may leave between the reaction of the primal and `from_dual`, in the
/// kinetic norm; 0 without it.
double apart_by_rounding(const convex::NearestPointProblem&, const GaussSolution&);

}  // namespace mechanics
