#pragma once

#include <optional>

#include "convex/cones/polyhedral_cone.hpp"

namespace convex::inline cones {

/// A face of a polyhedral cone: {x in K : a·x = 0 for its half-spaces a} = the cone of its generators and all
/// lines of K. Both lists hold all that apply, as increasing indices of K.generators and K.halfspaces.
struct ConeFace {
  Index dimension = 0;
  std::vector<Index> generators;
  std::vector<Index> halfspaces;
};

/// The face that has x in its relative interior; none when x is not in K. Exact.
std::optional<ConeFace> face_of(const PolyhedralCone& K, const ExactVector& x);

/// All faces, from the lineality space to K itself, by dimension: entry k has those of dimension
/// K.lineality() + k, in increasing order of their generators. Found upwards from face to face (after Kaibel
/// and Pfetsch 2002), in time about proportional to the number of pairs of neighbours: there may be many.
std::vector<std::vector<ConeFace>> faces(const PolyhedralCone& K);

/// The number of faces of each dimension 0 .. K.dimension().
std::vector<Index> f_vector(const PolyhedralCone& K);

}  // namespace convex::inline cones
