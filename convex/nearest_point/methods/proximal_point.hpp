#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// The proximal-point method on the multipliers, which is that of augmented Lagrangians (Rockafellar 1976),
/// each of them minimised by a damped Newton method on its pieces (Li, Sun and Toh 2018); dense or sparse. No
/// assumption on the rows: on dependent ones the multipliers converge to some that are right.
Solution proximal_point(const NearestPointProblem&, const Accuracy& = {});

/// The primal-dual active set method, which is a semismooth Newton method (Hintermüller, Ito and Kunisch
/// 2003): all rows with lambda_a > (u_a·q - s_a)/theta are held at once, again and again, until they are the
/// same. The same iteration with a small theta from the start; when rows come back and back, steps are damped
/// by the minimum of the augmented Lagrangian along them, which makes the method converge (Qi and Sun 1993).
Solution semismooth_newton(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
