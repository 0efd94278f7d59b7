#pragma once

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline sparse {

/// The interior-point method that begins the sparse active set, taken as far as doubles allow and left there:
/// an answer to some ten digits where the active rows do not settle, as in a large packing in which most
/// rows depend on each other. Its bound is an estimate by the residuals. gave_up: the equations cannot
/// be met, or multipliers grow beyond all bounds. Throws InvalidInput as `validate` does.
///
/// guess: where to begin, its q and lambda, if that has any: what solved a problem like this one.
Solution sparse_interior_point(const NearestPointProblem&, const Accuracy& = {}, const Solution& guess = {});

}  // namespace convex::inline sparse
