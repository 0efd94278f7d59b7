#pragma once

#include "convex/exact/integer.hpp"

namespace convex::inline cones {

/// A triangulation of the boundary of the section {x : y·x = 1} of the pointed cone that the rays generate,
/// by CGAL's triangulations with exact signs of determinants: each simplex r - 1 indices of rays, increasing.
/// The rays are distinct, span r >= 2 dimensions, and y·ray > 0. It is a proposal: `verified_facets` proves
/// it.
std::vector<std::vector<std::size_t>> section_hull(const IntegerRows& rays, const IntegerVector& y);

}  // namespace convex::inline cones
