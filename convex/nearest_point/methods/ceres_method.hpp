#pragma once

#include <string>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// The dual with a proximal term (Rockafellar 1976) is bounded least squares, solved by the trust-region
/// method of Ceres (Agarwal, Mierle and others) in a shared module that is loaded here; each call of Ceres is
/// one proximal step.
Solution ceres_method(const NearestPointProblem&, const Accuracy& = {});

/// Empty, or why the module cannot be had.
std::string why_no_ceres();

}  // namespace convex
