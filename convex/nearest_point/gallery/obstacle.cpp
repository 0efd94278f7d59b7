#include <algorithm>
#include <cmath>

#include "convex/nearest_point/gallery/draw.hpp"
#include "convex/nearest_point/gallery/families.hpp"

namespace convex::inline families {

/// A membrane over the plane, fixed at height 0 around a square of side x side points: A is the 5-point
/// Laplacian (4 and -1), U = I, s = 0. It is lifted in the middle and lies on the plane around; heights and
/// reactions are multiples of 2⁻⁴⁴, so z = Aq - lambda is exact.
GalleryInstance obstacle(Index side, double part_touching, std::uint32_t) {
  constexpr double unit = 0x1p-44;
  const auto rounded = [](double value) { return std::round(value / unit) * unit; };
  const Index n = side * side;
  const double h = 1 / static_cast<double>(side + 1);
  const auto bump = [&](Index i) {  // 16 x(1-x)y(1-y): 1 in the middle, 0 at the edge
    const double x = h * static_cast<double>(i % side + 1), y = h * static_cast<double>(i / side + 1);
    return 16 * x * (1 - x) * y * (1 - y);
  };
  Vector heights(n);
  for (Index i = 0; i < n; ++i) heights[i] = bump(i);
  Vector sorted = heights;
  std::sort(sorted.begin(), sorted.end());
  const auto touching = static_cast<Index>(std::lround(part_touching * static_cast<double>(n)));
  const double level = touching == 0 ? -1 : sorted[std::min(touching, n) - 1];
  Vector q(n), lambda(n);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < n; ++i) {
    const bool touches = heights[i] <= level;
    const double above = heights[i] - level;
    q[i] = touches ? 0 : std::max(unit, rounded(above * above));
    lambda[i] = touches ? std::max(unit, rounded(h * h * (1 - above))) : 0;
    entries.emplace_back(i, i, 4.0);
    if (i % side > 0) entries.emplace_back(i, i - 1, -1.0);
    if (i % side + 1 < side) entries.emplace_back(i, i + 1, -1.0);
    if (i >= side) entries.emplace_back(i, i - side, -1.0);
    if (i + side < n) entries.emplace_back(i, i + side, -1.0);
  }
  SparseMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  SparseRows U(n, n);
  U.setIdentity();
  const Vector z = A * q - lambda;
  return {{Metric::sparse(A), z, ConstraintRows(U), Vector::Zero(n), {}},
          true,
          DoubleDoubleVector(q),
          lambda,
          Vector(0)};
}

}  // namespace convex::inline families
