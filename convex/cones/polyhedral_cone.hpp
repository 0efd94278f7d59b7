#pragma once

#include "convex/exact/fraction.hpp"

namespace convex::inline cones {

/// A polyhedral cone K in n dimensions by both of its minimal descriptions (Minkowski 1896, Weyl 1935):
///   K = {Σ lambda_k g_k + Σ mu_l b_l : lambda >= 0} = {x : a·x <= 0, e·x = 0},
/// g the generators, b the lines (both ways), a the half-spaces, e the equations. Half-spaces and equations
/// are covectors, in plain coordinates. All rows are primitive integer vectors:
///   lines and equations are bases in reduced echelon form, which depend on K alone;
///   a generator is unique up to the lines, a half-space up to the equations.
/// Rows that were given keep their order and themselves, those that were found stand in increasing order.
/// Made by the functions below only, which prove what they return; they are exact for any data.
struct PolyhedralCone {
  Index n = 0;
  IntegerRows generators, lines, halfspaces, equations;

  /// Of the linear span.
  Index dimension() const { return n - static_cast<Index>(equations.size()); }
  /// Of the lineality space K ∩ -K.
  Index lineality() const { return static_cast<Index>(lines.size()); }
  bool is_pointed() const { return lines.empty(); }
  bool is_full() const { return halfspaces.empty() && equations.empty(); }
  bool is_zero() const { return generators.empty() && lines.empty(); }
};

/// The cone in n dimensions that generators and lines span; none at all make {0}. Zero, repeated and
/// redundant rows are ordinary input, so are generators that make up a line. Throws InvalidInput when n < 1
/// or a row has not n entries.
PolyhedralCone generated_cone(const ExactRows& generators, const ExactRows& lines, Index n);

/// {x : a·x <= 0, e·x = 0}; none at all make the whole space. Throws as above.
PolyhedralCone halfspace_cone(const ExactRows& halfspaces, const ExactRows& equations, Index n);

/// The same from doubles at their exact values, one vector a row. Throws InvalidInput as well when one is not
/// finite. `lines` and `equations` may be empty.
PolyhedralCone generated_cone(const Matrix& generators, const Matrix& lines = {});
PolyhedralCone halfspace_cone(const Matrix& halfspaces, const Matrix& equations = {});

/// The rows as doubles, each scaled to have integers where those are doubles, else a largest entry of 1.
RowMatrix nearest_directions(const IntegerRows& rows, Index n);

}  // namespace convex::inline cones
