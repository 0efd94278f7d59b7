#pragma once

#include "convex/gamma0/function.hpp"
#include "convex/nearest_point/problem.hpp"

namespace mechanics {

/// Gauss' function of the accelerations, G(q'') = ½ q''·A q'' - z·q'' (Moreau 1966, (10)), as a function of
/// the convex layer: to be added to others, conjugated, minimised. Appell's function of section 2 is
/// G + a number that the accelerations do not change.
convex::Function gauss_function(const convex::NearestPointProblem&);

/// Its gradient A q'' - z, summed to twice the working precision: A q'' alone loses cond(A)^(1/2) digits.
convex::Vector gauss_gradient(const convex::NearestPointProblem&, const convex::Vector& q);

/// The same with `appell` at q'' = 0, ½ ∫ Γ² dm - ∫ Γ·dF of the motion without accelerations.
convex::Function appell_function(const convex::NearestPointProblem&, double at_zero);

/// The accelerations that the contacts allow, {q'' : u_a·q'' >= s_a}, equality for two-sided rows. Throws
/// InvalidInput when there are none.
convex::Set allowed_accelerations(const convex::NearestPointProblem&);

}  // namespace mechanics
