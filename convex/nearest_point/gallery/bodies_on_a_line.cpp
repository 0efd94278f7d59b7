#include <algorithm>
#include <cmath>

#include "convex/nearest_point/gallery/draw.hpp"
#include "convex/nearest_point/gallery/families.hpp"

namespace convex::inline families {
namespace {

/// Powers of two from 1 to about `ratio`.
double weight(double ratio, double part) { return std::exp2(std::round(std::log2(ratio) * part)); }

}  // namespace

GalleryInstance heavy_on_light(Index bodies, double weight_ratio, std::uint32_t seed) {
  Draw draw(seed);
  const double lift = draw.integer(1, 4), gravity = 8;
  Vector weights(bodies), lambda(bodies);
  for (Index i = 0; i < bodies; ++i)
    weights[i] = weight(weight_ratio, static_cast<double>(i) / static_cast<double>(bodies - 1));
  RowMatrix U = RowMatrix::Zero(bodies, bodies);
  double above = 0;
  for (Index i = bodies - 1; i >= 0;
       --i) {  // the sum of the weights above is rounded, the lightest first lost
    above += weights[i];
    lambda[i] = (lift + gravity) * above;
    U(i, i) = 1;
    if (i > 0) U(i, i - 1) = -1;
  }
  Vector s = Vector::Zero(bodies);
  s[0] = lift;
  return {{Metric::diagonal(weights), -gravity * weights, ConstraintRows(U), s, {}},
          true,
          DoubleDoubleVector(Vector::Constant(bodies, lift)),
          lambda,
          Vector(0)};
}

GalleryInstance chain(Index bodies, double weight_ratio, std::uint32_t seed) {
  Draw draw(seed);
  Vector weights(bodies), q(bodies), lambda = Vector::Zero(bodies - 1), z(bodies);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < bodies; ++i) {
    weights[i] = weight(weight_ratio, draw.integer(0, 16) / 16);
    const bool pushed = i > 0 && draw.index(8) != 0;
    q[i] = i == 0 ? 0 : q[i - 1] + (pushed ? 0 : draw.integer(1, 4));
    if (pushed) lambda[i - 1] = draw.integer(1, 64);
  }
  for (Index i = 0; i < bodies; ++i)
    z[i] = weights[i] * q[i] - (i > 0 ? lambda[i - 1] : 0) + (i + 1 < bodies ? lambda[i] : 0);
  for (Index a = 0; a + 1 < bodies; ++a) {
    entries.emplace_back(a, a, -1.0);
    entries.emplace_back(a, a + 1, 1.0);
  }
  SparseRows U(bodies - 1, bodies);
  U.setFromTriplets(entries.begin(), entries.end());
  return {{Metric::diagonal(weights), z, ConstraintRows(U), Vector::Zero(bodies - 1), {}},
          true,
          DoubleDoubleVector(q),
          lambda,
          Vector(0)};
}

}  // namespace convex::inline families
