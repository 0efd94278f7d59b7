#pragma once

#include "convex/nearest_point/problem.hpp"
#include "tests/oracles/rational_elimination.hpp"

namespace oracles {

/// The solution of A q - U_Wᵀ lambda = z, U_W q = s_W in fractions, by Gaussian elimination; rows of W that
/// depend on the others get multiplier 0. It shares nothing with the solver but the data.
struct RationalPoint {
  RationalVector q;       // n
  RationalVector lambda;  // m
};
RationalPoint solve_kkt(const convex::NearestPointProblem&, const std::vector<convex::Index>& rows);

/// Whether the point satisfies every condition (2), (7)-(9) of Moreau 1966 exactly: it is then the solution.
bool is_exact_solution(const convex::NearestPointProblem&, const RationalPoint&);

/// ||q - exact||_A over max(||exact||_A, ||z||_(A⁻¹)), evaluated in fractions and rounded at the end. The
/// scale is that of doubles, given by the caller.
double relative_error(const convex::NearestPointProblem&, const convex::Vector& q, const RationalPoint& exact,
                      double scale);

/// The Gram matrix of a metric of any kind.
convex::Matrix gram(const convex::Metric& A);

/// wᵀU = 0, w·s > 0 and w_a >= 0 on one-sided rows, exactly.
bool is_exact_farkas_witness(const convex::NearestPointProblem&, const RationalVector& w);

/// wᵀU = 0, w·s > 0 and w_a >= 0 on one-sided rows, in fractions, wᵀU to `slack` of its largest term.
bool is_farkas_witness(const convex::NearestPointProblem&, const convex::Vector& w, double slack);

}  // namespace oracles
