#pragma once

#include <vector>

#include "convex/nearest_point/model.hpp"
#include "convex/nearest_point/problem.hpp"

namespace convex::inline reductions {

/// The rows that q = 0, when it is admissible, proves to be slack: the answer then lies in the ball with 0
/// and A⁻¹z at the ends of a diameter, and row a is out of reach when u_a·A⁻¹z/2 - s_a > ||u_a||_(A⁻¹)
/// ||z||_(A⁻¹)/2. Empty when 0 is not admissible. In order. Rounding is allowed for.
std::vector<Index> rows_out_of_reach(const NearestPointProblem&);

/// The problem with only the rows `kept`, in order.
NearestPointProblem with_rows(const NearestPointProblem&, const std::vector<Index>& kept);

}  // namespace convex::inline reductions
