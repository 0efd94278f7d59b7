#pragma once

#include "convex/cones/polyhedral_cone.hpp"
#include "convex/exact_program/exact_program.hpp"
#include "convex/gamma0/function.hpp"

namespace convex::inline sets {

/// normal·v <= limit, or = limit.
struct ExactHalfspace {
  IntegerVector normal;
  Integer limit;
};

/// A polyhedron in n dimensions by both of its minimal descriptions, in fractions (Minkowski 1896, Weyl
/// 1935):
///   the convex hull of the vertices, plus the cone of the rays and lines (both ways)
///   = {v : a·v <= b, e·v = f}.
/// Where there are lines, a vertex is unique up to them. Empty where there is no vertex.
struct ExactPolyhedron {
  std::size_t n = 0;
  std::vector<Fractions> vertices;
  IntegerRows rays, lines;
  std::vector<ExactHalfspace> halfspaces, equations;

  bool is_empty() const { return vertices.empty(); }
  bool is_point() const { return vertices.size() == 1 && rays.empty() && lines.empty(); }
};

/// The polyhedron {v : (v, 1) in K} of a cone K in n + 1 dimensions whose last entry is nowhere negative.
ExactPolyhedron section_at_one(const PolyhedralCone& K);
/// A cone as a polyhedron with the vertex 0.
ExactPolyhedron polyhedron_of(const PolyhedralCone& K);
ExactPolyhedron empty_polyhedron(std::size_t n);

/// Throws InvalidInput where v has not n entries; so does `support_of`.
bool contains(const ExactPolyhedron& P, const Fractions& v);
/// sup of d·v over v in P; none where it is +inf. P is not empty.
std::optional<Fraction> support_of(const ExactPolyhedron& P, const Fractions& d);
/// {v + shift}.
ExactPolyhedron translated(ExactPolyhedron P, const Fractions& shift);

/// {Mv : v in P}, M by rows of its nonzero entries.
ExactPolyhedron image(const ExactPolyhedron& P, const std::vector<ExactRow>& M);
/// {v + w : v in P, w in Q}.
ExactPolyhedron sum(const ExactPolyhedron& P, const ExactPolyhedron& Q);
/// {(v, w) : v in P, w in Q}.
ExactPolyhedron product(const ExactPolyhedron& P, const ExactPolyhedron& Q);
/// The convex hull of P and Q, which are not empty, closed.
ExactPolyhedron hull(const ExactPolyhedron& P, const ExactPolyhedron& Q);
ExactPolyhedron intersection(const ExactPolyhedron& P, const ExactPolyhedron& Q);

/// The indicator of P as a program in fractions.
ExactProgram program_of(const ExactPolyhedron& P);

/// P as a set of the language, its numbers rounded once: membership is its indicator's value, the support
/// function its conjugate, the projection its prox. Throws InvalidInput when P is empty.
Set as_set(const ExactPolyhedron& P);

}  // namespace convex::inline sets
