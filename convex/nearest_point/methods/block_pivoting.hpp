#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// Block principal pivoting (Júdice and Pires 1994; Portugal, Júdice and Vicente 1994): all rows of a wrong
/// sign change sides at once while their number falls, three blocks of patience beyond, then one at a time,
/// the last in order first (Murty 1974), which is finite. On M + ridge I, definite whatever the rows, in
/// proximal steps (Rockafellar 1976).
Solution block_pivoting(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex
