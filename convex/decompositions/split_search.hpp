#pragma once

#include "convex/decompositions/split_candidate.hpp"

namespace convex::inline decompositions {

/// A split that the values bear out, from one look at f: the two proxes, or where the values of f and of its
/// conjugate do not bear these out, another pair of a point and its covector near them. Its status is
/// `solved` where the values are known to the tolerance, else `inaccurate`; the bound is then what they prove
/// of the two proxes. Throws `InvalidInput` where a prox does, and no other way finds a pair.
Decomposition searched_split(const SplitFunctions& of, const Vector& z, const Metric& W, double tolerance,
                             const Look& look);

/// Does what the values leave open stay within the bound, and the bound within `enough`?
bool is_borne_out(const SplitCandidate& made, double enough, double tolerance);

}  // namespace convex::inline decompositions
