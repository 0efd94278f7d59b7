#pragma once

#include <optional>

#include "convex/atlas/row_space.hpp"
#include "convex/cones/cone_faces.hpp"

/// The subdivision of the space of z into the polyhedra on which z -> proj_C z is affine, exactly.
namespace convex::atlas {

/// The z whose answer lies in the relative interior of one face F of the polyhedron of points, closed:
///   cell = {A q - Σ lambda_a u_a : q in F, lambda_a >= 0},
/// the sum over the rows tight on F (lambda_a of either sign where the row is two-sided). Cells of all faces
/// fill the space and meet in faces of each other (the normal manifold: Robinson 1992; Rockafellar and Wets
/// 1998, 6.46); A F and the cone of the u_a are at right angles in A⁻¹.
struct Cell {
  std::vector<std::size_t> rows;  ///< tight on F, increasing: the rows with equality in the answer
  Index freedom = 0;              ///< the dimension of F in the space of q
  ConeFace face;                  ///< of RowSpace::cone; left out by `explored`
  std::vector<std::size_t> walls;
};

/// A facet that two cells share, in the hyperplane normal·z = offset. The tighter cell, whose rows hold more,
/// has normal·z <= offset; in the looser one F is larger by one dimension.
struct Wall {
  std::size_t tighter = 0, looser = 0;  ///< cells
  IntegerVector normal;                 ///< primitive; an acceleration, for it is a covector of z: n
  Fraction offset;
  IntegerVector form;       ///< form·(c, 1) has the sign of normal·z - offset, c the free point: r + 1
  Fraction squared_length;  ///< normal·A normal: distances in A⁻¹ are (normal·z - offset) over its root
};

struct Atlas {
  RowSpace space;
  std::vector<Cell> cells;  ///< by freedom, then by rows
  std::vector<Wall> walls;
  bool is_conical = false;   ///< every wall passes through one point; told of a whole atlas
  std::size_t explored = 0;  ///< cells, the first ones, all of whose walls are there
  bool is_complete() const { return explored == cells.size(); }
};

/// All cells and walls. Without a feasible point there are none.
Atlas atlas(const ExactProblem&);

/// The cell at the problem's z, then from wall to wall the cells next to it, until `most` of them are
/// explored or there are no more; those beyond are there by name, with the walls that led to them. Faces are
/// told by their rows alone: whether rows hold together is decided for each set by exact linear programming,
/// so that neither vertices nor all faces need be known.
Atlas explored(const ExactProblem&, std::size_t most);

/// normal·z - offset.
Fraction side(const Wall&, const ExactVector& z);

/// The cells that contain z, at least one: several where it lies on walls.
std::vector<std::size_t> cells_at(const Atlas&, const ExactVector& z);

/// The wall between the cells of these rows: of the basis of the looser one's rows, and one row more that the
/// tighter one has. Its cells are left open.
Wall wall_between(const RowSpace&, const std::vector<std::size_t>& looser_basis, std::size_t one_more);

/// Independent rows among these, each taken where it adds to those before it.
std::vector<std::size_t> independent(const RowSpace&, const std::vector<std::size_t>& rows);

}  // namespace convex::atlas
