#pragma once

#include <vector>

#include "convex/vector.hpp"

namespace convex {

/// The operator d u_ij - c (u of the four neighbours) on width×height points inside a frame of zeros, seen
/// only on free points; fields are stored with their frame, (width + 2)×(height + 2), row by row.
struct GridOperator {
  Index width = 0, height = 0;
  double d = 4, c = 1;
  Vector free;  ///< 1 on free points, else 0

  Index stride() const { return width + 2; }
  Index size() const { return (width + 2) * (height + 2); }
  Index at(Index i, Index j) const { return (j + 1) * stride() + i + 1; }
  Vector field() const { return Vector::Zero(size()); }
};

/// free ∘ (A u): out. u vanishes off the points.
void apply(const GridOperator&, const Vector& u, Vector& out);

/// A V-cycle as a preconditioner (Brandt 1977; for free sets, truncated as by Kornhuber 1994): two steps of
/// Jacobi's method with the weights of Chebyshev's polynomial on the upper part of the spectrum before and,
/// in reverse, after; bilinear interpolation and its transpose; a coarse point is free when the fine point at
/// its place is.
class GridMultigrid {
 public:
  explicit GridMultigrid(const GridOperator& finest);
  void set_free(const Vector& free);
  const GridOperator& finest() const { return levels_.front(); }

  /// Conjugate gradients on A u = r over the free points from u = 0 until the residual is `part` of the first
  /// or the limit of steps is reached; returns the energy norm of u.
  double solve(const Vector& r, double part, Vector& u);
  Index steps() const { return steps_; }

 private:
  void cycle(std::size_t level);

  std::vector<GridOperator> levels_;
  std::vector<Vector> u_, r_, rest_;
  Index steps_ = 0;
};

/// Bilinear interpolation from the coarse grid of a level to it, and its transpose; points off the grids
/// count as 0.
void interpolate(const GridOperator& coarse, const Vector& from, const GridOperator& fine, Vector& to);
void restrict_to(const GridOperator& fine, const Vector& from, const GridOperator& coarse, Vector& to);
/// The grid of the points with odd numbers.
GridOperator coarsened(const GridOperator& fine);

}  // namespace convex
