#pragma once

#include "convex/atlas/atlas.hpp"

namespace convex::atlas {

/// Sets of indices without a repetition, increasing.
using Places = std::vector<std::size_t>;

/// The cone that generators span, cut into simplicial ones without new generators: the first generator with
/// the pieces of each facet that does not hold it ("pulling", Stanley 1980). `facets`: for each facet of the
/// cone the generators on it; `dimension`: of the cone.
std::vector<Places> simplicial_pieces(const Places& generators, const std::vector<Places>& facets,
                                      std::size_t dimension);

/// A simplicial cone apex + {Σ mu_k d_k : mu_k >= 0}, counted with a sign.
struct SignedCone {
  int sign = 1;
  ExactVector apex;
  IntegerRows directions;
};

/// Simplicial cones whose indicators, with their signs, sum to that of the polyhedron of a face with a
/// vertex, but for sets of lower dimension: at each vertex the pieces of its tangent cone, each edge that
/// goes down along one linear functional turned round with a change of sign (Lawrence 1991; Varchenko 1987).
/// The functional increases on the rays, so it is right for unbounded polyhedra as well. `cone`: {(y tau,
/// tau)} of a polyhedron without lines; `levels`: faces(cone).
std::vector<SignedCone> signed_cones(const PolyhedralCone& cone,
                                     const std::vector<std::vector<ConeFace>>& levels, const ConeFace& face);

}  // namespace convex::atlas
