#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "convex/vector.hpp"

namespace convex::inline obstacle_problem {

/// What a point of a grid is.
enum class CutPoint : std::uint8_t {
  beyond,   ///< no unknown, and nothing is known there: beyond a wall
  fixed,    ///< no unknown: beyond, or on, a boundary where values are given
  free,     ///< an unknown of any sign
  bounded,  ///< an unknown >= 0
};

/// A value y >= 0 that hangs on an unknown by a conductance c: it adds ½ c (q + shift - y)² to the energy, or
/// ½ c min(0, q + shift)² once y is eliminated.
struct Pendant {
  Index point = 0;
  double conductance = 0, shift = 0;
};

/// An obstacle problem on the points of a grid in one to three dimensions: minimise
///   ½ Σ links (q_i - q_j)² + ½ Σ pull q_i² - Σ load q_i + pendants,  q >= 0 on bounded points.
/// Links join neighbours along axes, and unknowns only. All are >= 0, so that the matrix is a symmetric
/// M-matrix, the metric; the solution is the point of the cone nearest to that of no bounds. Fields have a
/// frame of one point a used axis; the first axis is the fastest.
struct CutGrid {
  std::size_t dimension = 1;
  std::array<Index, 3> points{1, 1, 1};  ///< a used axis has at least 2
  std::vector<CutPoint> kind;
  std::array<std::vector<double>, 3> link;  ///< to the next point along the axis
  std::vector<double> pull, load;
  std::vector<Pendant> pendants;

  /// For these points: all beyond, without links.
  CutGrid(std::size_t dimension, const std::array<Index, 3>& points);
  CutGrid() = default;
  Index frame(std::size_t axis) const { return axis < dimension ? 1 : 0; }
  Index stride(std::size_t axis) const { return strides_[axis]; }
  Index size() const { return static_cast<Index>(kind.size()); }
  Index at(Index i, Index j = 0, Index k = 0) const {
    return (i + frame(0)) * strides_[0] + (j + frame(1)) * strides_[1] + (k + frame(2)) * strides_[2];
  }
  bool is_unknown(Index k) const { return kind[static_cast<std::size_t>(k)] >= CutPoint::free; }
  Index unknowns() const;

 private:
  std::array<Index, 3> strides_{1, 0, 0};
};

}  // namespace convex::inline obstacle_problem
