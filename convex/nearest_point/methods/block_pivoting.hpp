#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline algorithms {

/// Block principal pivoting (Júdice and Pires 1994; Portugal, Júdice and Vicente 1994): all rows of a wrong
/// sign change sides at once while their number falls, three blocks of patience beyond, then the worst of
/// them alone, twice as often as there can be rows held. On M + ridge I, definite whatever the rows, in
/// proximal steps (Rockafellar 1976). What does not settle so goes on from the rows found by the steps of
/// `active_set`, principal pivots on one row at a time with an orthogonal factor (Dantzig and Cottle 1968),
/// which are finite.
Solution block_pivoting(const NearestPointProblem&, const Accuracy& = {});

}  // namespace convex::inline algorithms
