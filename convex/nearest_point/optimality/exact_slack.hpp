#pragma once

#include <optional>
#include <vector>

#include "convex/nearest_point/problem.hpp"

/// Signs of slacks without rounding, for rows whose slack twice the working precision cannot tell from zero.
namespace convex {

/// The sign of u_a·q - s_a.
int slack_sign(const NearestPointProblem&, Index a, const Vector& q);

/// The sign of u_p·q - s_p at every q where the rows `held` hold with equality: +, 0 or -. None unless u_p is
/// the sum of c_k / c_0 u_k over `held` with whole numbers c up to `largest_denominator` that `coefficients`
/// are close to: then not one bit is left over. coefficients: one a row held.
std::optional<int> slack_sign_on_edge(const NearestPointProblem&, Index p, const std::vector<Index>& held,
                                      const double* coefficients);

/// Whether the doubles q are the point of the rows `held` and keep the rows `touched`, all without rounding:
/// the rows held and two-sided ones have a slack of 0, the others none below. With multipliers lambda >= 0 of
/// the rows held, ||q - q*||_A <= ||Aq - z - Uᵀlambda||_(A⁻¹) then, q* the solution.
bool keeps_exactly(const NearestPointProblem&, const Vector& q, const std::vector<Index>& held,
                   const std::vector<Index>& touched);

}  // namespace convex
