#pragma once

#include <string>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// Each proximal step on the multipliers y (Rockafellar 1976) is the nonlinear least-squares problem
/// ½|d|² + Σ ½/theta (theta y_a + b_a - v_a·d)²₊, solved by the trust-region method of Ceres (Agarwal, Mierle
/// and others) in a shared module that is loaded here. Its dual is least squares in y >= 0 with a proximal
/// term; given to Ceres in that form, with bounds, projected steps stall at the bounds.
Solution ceres_method(const NearestPointProblem&, const Accuracy& = {});

/// Empty, or why the module cannot be had.
std::string why_no_ceres();

}  // namespace convex::inline algorithms
