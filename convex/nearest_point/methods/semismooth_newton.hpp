#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// The primal-dual active set method, which is a semismooth Newton method (Hintermüller, Ito and Kunisch
/// 2003): all rows with lambda_a > (u_a·q - s_a)/theta are held at once, again and again, until they are the
/// same. Equations are regularised by a small theta and corrected by proximal steps. When rows come back and
/// back, steps are damped by the minimum of the augmented Lagrangian along them, which makes the method
/// converge (Qi and Sun 1993). Dense or sparse.
Solution semismooth_newton(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
