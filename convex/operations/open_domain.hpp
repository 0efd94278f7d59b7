#pragma once

#include "convex/composite/graph_form.hpp"

namespace convex::inline operations {

/// Do rows show that no point has all terms of f finite? Each term's domain lies within rows: those of its
/// program where it is piecewise linear-quadratic, else the bounds of its entries, without the end where the
/// term is +inf there, as -log is at 0. With rows G ξ >= h, and P ξ > p for the ends left out, there is a
/// point exactly when there are ξ and τ with
///   G ξ - h τ >= 0,  P ξ - p τ >= 1,  τ >= 1
/// (ξ/τ is the point): closed rows, whose contradiction is decided exactly. True is a proof; false is not, as
/// sets that are not polyhedral enter by the bounds of their entries alone.
bool has_empty_open_domain(const GraphForm& f);

}  // namespace convex::inline operations
