#pragma once

#include "convex/obstacle_problem/cut_obstacle.hpp"

namespace convex::inline obstacle_problem {

/// A proved bound of |q - q*| in the largest norm, q* the minimum on the finest grid for the doubles that the
/// grid holds; infinite where nothing is proved, as without pull, where q* may be known up to a constant
/// only.
///
/// With the linear part L of the gradient F and a w > 0 with L w > 0, q + δw is a supersolution if
/// F(q) + δ L w >= 0, and q - δw a subsolution if F(q) - δ L w <= 0 where q > 0 or has no bound. L is a
/// symmetric M-matrix and what pendants add grows with q, so that q* lies between them (R. S. Varga 1962,
/// section 3.5; R. W. Cottle, J.-S. Pang and R. E. Stone 1992, section 3.11). L w > 0 proves at once that L
/// is regular. All of it is checked with bounds of what each sum has rounded.
double enclosed_error(const std::vector<const CutGrid*>& grids, const CutSolution& found);

}  // namespace convex::inline obstacle_problem
