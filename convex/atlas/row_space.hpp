#pragma once

#include "convex/cones/polyhedral_cone.hpp"
#include "convex/nearest_point/proof/exact_problem.hpp"

namespace convex::atlas {

/// The nearest-point problem as its answer depends on z, in r coordinates y, r the rank of the rows: q itself
/// where r = n, else y_k = u_k·q for r independent rows. Of z only the free point c matters, A⁻¹z in these
/// coordinates; the answer is the point nearest to c, in the metric that A induces, of a polyhedron
/// {y : e_a·y >= s_a} without a line in it.
struct RowSpace {
  Index n = 0;
  std::size_t rank = 0;     ///< r
  IntegerRows rows;         ///< primitive; row_scale_a rows_a = (e_a, -s_a) times a number > 0 common to all
  IntegerVector row_scale;  ///< > 0
  IntegerRows directions;   ///< A⁻¹u_a = factor directions_a: n
  IntegerRows gram;         ///< u_a·A⁻¹u_b = factor gram_ab, of all rows
  IntegerVector s;          ///< in the scale of `directions` and `gram`
  Fraction factor;          ///< > 0
  std::vector<bool> two_sided;
  /// The metric of y is gauge metric, its inverse a positive multiple of `inverse`: r×r.
  IntegerRows metric, inverse;
  Fraction gauge;
  IntegerRows free_rows;  ///< c = factor free_rows z: r×n
  /// {(y tau, tau) : y in the polyhedron, tau > 0}, closed: pointed. Left out by `row_space`.
  PolyhedralCone cone;

  std::size_t count() const { return rows.size(); }
  /// Whether some y satisfies every row.
  bool is_feasible() const;
};

RowSpace row_space(const ExactProblem&);

/// Finds the cone by all of its generators, of which there may be many.
void find_cone(RowSpace&);

}  // namespace convex::atlas
