#pragma once

#include <vector>

#include "convex/double_double.hpp"
#include "convex/nearest_point/problem.hpp"

namespace convex::inline optimality {

/// z + Σ lambda_k u_k - A q, k over `rows`, with the data as they are and sums in twice the working
/// precision, rounded once at the end: n.
Vector stationarity_residual(const NearestPointProblem&, const DoubleDoubleVector& q,
                             const std::vector<Index>& rows, const DoubleDoubleVector& lambda);

/// The same over all rows.
Vector stationarity_residual(const NearestPointProblem&, const DoubleDoubleVector& q, const Vector& lambda);

/// u_a·q - s_a in twice the working precision.
DoubleDouble slack(const NearestPointProblem&, Index a, const DoubleDoubleVector& q);

}  // namespace convex::inline optimality
