#pragma once

#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace convex::inline multiplier_sets {

/// What errors of equations amount to, as far as corners were looked at.
struct LargestMove {
  double of_point = 0;
  Vector of_multipliers;  ///< |S|: the largest |dlambda| of the corners looked at
};

/// How far the point of the rows S = `held` moves, max ||dq||_A over |r1| <= balance and |r2| <= rows entry
/// by entry, where A dq - U_Sᵀ dlambda = r1 and U_S dq = r2: what errors of that size in z + U_Sᵀlambda - A q
/// and s_S - U_S q amount to. Rows that depend on others within their rounding are left out. The maximum of a
/// convex function over a box lies at a corner; corners are climbed by the signs of the gradient, as in
/// estimates of condition numbers (Higham 2002, section 15.2). An estimate from below, rarely off by more
/// than a small factor. balance: n; rows: |S|. Infinite where a radius or the answer is.
LargestMove largest_move(const NearestPointProblem&, const std::vector<Index>& held, const Vector& balance,
                         const Vector& rows);

/// The same with an empty working set: max ||r1||_(A⁻¹), which bounds the part of r1 in any case.
double largest_move(const Metric&, const Vector& balance);

}  // namespace convex::inline multiplier_sets
