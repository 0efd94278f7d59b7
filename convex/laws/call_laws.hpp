#pragma once

#include "convex/laws/laws.hpp"

namespace convex::inline law_checks {

/// The laws of what a call means on Rⁿ (a set stands for its indicator), in the trial metrics; in each the
/// call is made anew in that product, on which conjugates, envelopes and supports depend. A few points
/// each: the origin, ties, whole numbers, a near and a far one, and for the boundary a prox point and one
/// just outside. A function that cannot be made or tried fails a check that says why.
LawReport laws(const Call& call, Index n);
LawReport laws(const Call& call, const std::vector<NamedMetric>& metrics);

}  // namespace convex::inline law_checks
