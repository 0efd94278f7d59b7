#pragma once

#include <optional>

#include "convex/nearest_point/proof/held_point.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline proof {

/// As `enclosed_error`, for problems too large for dense factors whose A is sparse or diagonal: with lower
/// bounds on eigenvalues that sparse Cholesky factors prove, and the residuals of the solution as it stands.
/// Wider than that of `enclosed_error` by about the root of the condition number. `held`: the rows thought to
/// be active.
std::optional<double> sparse_enclosed_error(const NearestPointProblem&, const RadiiOf&, const Solution&,
                                            const std::vector<Index>& held);

/// The same from a point that doubles hold (`residual_of_kept_point`), without the rows.
std::optional<double> sparse_kept_error(const NearestPointProblem&, const RadiiOf&, const Solution&);

/// A number below all eigenvalues of M + E, M symmetric and sparse, for every symmetric E with row sums of
/// |E| at most `uncertainty`; none when no positive one was found. A Cholesky factor L of M - shift I that is
/// found in doubles without a negative pivot is the exact one of a matrix within gamma |L||L|ᵀ (Higham 2002,
/// theorem 10.3; Rump 2006).
std::optional<double> least_eigenvalue_below(const SparseMatrix& M, double uncertainty);

}  // namespace convex::inline proof
