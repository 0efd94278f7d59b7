#pragma once

#include "convex/laws/map_laws.hpp"

namespace convex::inline law_checks {

Matrix rounded_gram(const ExactMetric& W);

/// The pair of points, with their images, if it is stretched.
std::optional<MapCounterexample> pair_broken(const ExactMetric& W, std::vector<ExactVector> points,
                                             std::vector<MapImage> images);
/// The cycle of points, with their images, if the sum of (T x_i | x_i - x_(i+1)) is negative.
std::optional<MapCounterexample> cycle_broken(const ExactMetric& W, std::vector<ExactVector> points,
                                              std::vector<MapImage> images);

/// Not finite where T has no value.
Vector image_in_doubles(const Map& T, const Vector& z);

/// Corners in the plane of two coordinates, anticlockwise from i to j, multiples of 2^-20.
std::vector<Vector> regular_polygon(const Vector& centre, Index i, Index j, double radius, int corners);

/// A square, anticlockwise from i to j, each side in so many equal parts, a power of two.
std::vector<Vector> square(const Vector& corner, Index i, Index j, double side, int parts);

/// Whether doubles leave it open that the sum over the cycle is negative.
bool may_go_down(const Map& T, const Matrix& gram, const std::vector<Vector>& corners);

/// S = W T' at a point, by derivatives or by central differences.
struct SlopeOfMap {
  Index n = 0;
  bool is_derivative = false;
  std::vector<Fraction> S;     ///< n·n by rows
  std::vector<double> radius;  ///< of each row of S; of derivatives
  const Fraction& at(Index i, Index j) const { return S[static_cast<std::size_t>(i * n + j)]; }
  /// The largest |S_ij - S_ji| over the largest |S_ij|.
  double asymmetry() const;
  /// No difference is beyond its radius.
  bool is_symmetric() const;
  /// (i, j) with the largest |S_ij - S_ji|, in the order in which squares go down; i = j where all are 0.
  std::pair<Index, Index> most_turning_plane() const;
  /// Of a square's side a, b, in N parts each, an affine T has the sum (S_ii + S_jj) a²/N - |S_ij - S_ji| a²:
  /// the least power of two that makes it negative, with as much again for a T that bends; none where the
  /// square would have more corners than `most_corners`.
  std::optional<int> parts_of_side(Index i, Index j) const;
};
/// Corners of a cycle that is written out; of a map that turns less its derivative speaks alone.
inline constexpr int most_corners = 4096;

std::optional<SlopeOfMap> slope_at(const Map& T, const ExactMetric& W, const Vector& point);

/// The entries of W T' that differ, if derivatives show it.
std::optional<MapCounterexample> asymmetric(const Map& T, const SlopeOfMap& slope, const Vector& point);

}  // namespace convex::inline law_checks
