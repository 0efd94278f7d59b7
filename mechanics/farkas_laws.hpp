#pragma once

#include "convex/laws/check.hpp"
#include "convex/nearest_point/problem.hpp"

namespace mechanics {

/// The laws of Farkas weights w, which say that no acceleration satisfies the rows: their signs, w.U = 0 and
/// w.s > 0. As w.U is 0 to its rounding only, the point that comes nearest to meeting all rows with weights,
/// as equations, is a second witness: w.s must exceed what rounding may make of the rows there. w: m.
convex::LawReport farkas_laws(const convex::NearestPointProblem&, const convex::Vector& w);

}  // namespace mechanics
