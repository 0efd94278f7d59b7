#pragma once

#include "convex/exact/integer.hpp"

namespace convex::inline cones {

/// The facets of the pointed cone that the rays generate: {x : a·x <= 0 for every row a}, primitive, in
/// increasing order. `touching`, one list a facet: the rays on it, increasing.
struct Facets {
  IntegerRows normals;
  std::vector<std::vector<std::size_t>> touching;
};

/// The facets in whose planes the simplices lie, proved in exact arithmetic to be all of them:
///   each simplex spans a plane (rank r - 1) with every ray on one side, so it is part of the boundary;
///   each ridge of a simplex lies in exactly two, so together they cover the boundary the same number of
///   times everywhere, modulo two;
///   the ray through the middle of one simplex meets no other, so that number is one.
/// When one of these fails the program stops (`invariant`): no unproved facet leaves here.
/// The rays span r >= 2 dimensions; each simplex has r - 1 of them, increasing.
Facets verified_facets(const IntegerRows& rays, std::size_t r,
                       const std::vector<std::vector<std::size_t>>& simplices);

}  // namespace convex::inline cones
