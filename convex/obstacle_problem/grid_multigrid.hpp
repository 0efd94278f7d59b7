#pragma once

#include <array>
#include <vector>

#include "convex/vector.hpp"

namespace convex::inline obstacle_problem {

/// The operator d u_ij - c (u of the four neighbours) on width×height points inside a frame of zeros, seen
/// only on free points; fields are stored with their frame, (width + 2)×(height + 2), row by row.
struct GridOperator {
  Index width = 0, height = 0;
  double d = 4, c = 1;

  Index stride() const { return width + 2; }
  Index size() const { return (width + 2) * (height + 2); }
  Index at(Index i, Index j) const { return (j + 1) * stride() + i + 1; }
  Vector field() const { return Vector::Zero(size()); }
};

/// The grid of the points with odd numbers, the operator scaled with it.
GridOperator coarsened(const GridOperator& fine);

/// Conjugate gradients on the free points with a V-cycle as preconditioner (Brandt 1977; for free sets,
/// truncated as by Kornhuber 1994): a red-black sweep before and, in reverse, after; bilinear interpolation
/// and its transpose; a coarse point is free when the fine point at its place is. What is held, and the edges
/// of the grid, begin between the points of coarse grids, to which their neighbours there are tied by the
/// shorter links that finite volumes have. All in single precision, which halves what is read and doubles
/// what is done at once: digits come from residuals that the caller computes anew. Directions are made
/// conjugate by Polak and Ribière's formula, which bears roundings best.
class GridMultigrid {
 public:
  explicit GridMultigrid(const GridOperator& finest);
  /// free: 1 on free points, else 0, the frame included.
  void set_free(const Vector& free);

  /// Energy norms of u and of what it lacks: the square of the latter is r·(V-cycle of r) before the last
  /// step, which differs from it by the V-cycle's own error, a small part.
  struct Size {
    double found, missing;
  };
  /// A u = r over the free points from u = 0 until `missing` is at most `part` of `found` or `absolute`, or
  /// the limit of steps is reached. part: at least 1e-4, to which single precision suffices.
  Size solve(const Vector& r, double part, Vector& u, double absolute = 0);
  Index steps() const { return steps_; }

 private:
  /// How far what is held begins to the left, right, below and above, in widths of the grid.
  using Edges = std::array<float, 4>;
  /// u, r, free on one grid, and room for rows; each row begins with a spare entry.
  struct Level {
    Index width, height;
    float c;
    float free_d;                     ///< of a point whose neighbours are free
    std::vector<float> d, inverse_d;  ///< of the finest grid one row, of the others all
    std::vector<float> free, u, r, even, odd, mean, sum, last;
    std::vector<Edges> edges;  ///< 1 where the neighbour is free or the next point held; not of the finest
    Index stride() const { return width + 2; }
    Index at(Index j) const { return (j + 1) * stride() + 1; }
    const float* of_row(const std::vector<float>& x, Index j) const {
      return x.data() + (edges.empty() ? 0 : at(j));
    }
    /// 1 on the points of row j that are red (or black), else 0.
    const float* colour(Index j, bool red) const { return ((j % 2 == 0) == red ? even : odd).data() + 1; }
  };
  static Level level(const GridOperator&, bool is_finest);
  static void set_coarse(const Level& fine, Level& coarse);
  static void sweep_row(Level&, Index j, bool red);
  static void descend(Level& fine, Level& coarse);
  template <class RowDone>
  static void ascend(const Level& coarse, Level& fine, RowDone row_done);
  template <class RowDone>
  void cycle(std::size_t level, RowDone row_done);

  GridOperator finest_;
  std::vector<Level> levels_;
  std::vector<float> x_, p_, Ap_;
  Index steps_ = 0;
};

}  // namespace convex::inline obstacle_problem
