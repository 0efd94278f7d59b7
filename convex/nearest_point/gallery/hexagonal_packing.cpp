#include <algorithm>
#include <cmath>

#include "convex/nearest_point/gallery/draw.hpp"
#include "convex/nearest_point/gallery/families.hpp"

namespace convex::inline families {
namespace {

/// sin 60°, cut to 28 bits, so that its products with small integers are exact.
constexpr double height = 0x1.bb67ae8p-1;

/// A pile as rows of equal discs, each row half a disc further right; disc (r, c) at (c + r/2, r sin 60°).
struct Pile {
  Index discs, width;
  Index row(Index i) const { return i / width; }
  Index rows() const { return row(discs - 1) + 1; }
};

struct TouchingPair {
  Index low, high;  ///< discs; low = -1 is the floor
  double nx, ny;    ///< the normal from low to high
};

std::vector<TouchingPair> touching_pairs(const Pile& pile) {
  std::vector<TouchingPair> all;
  for (Index i = 0; i < pile.discs; ++i) {
    const Index column = i % pile.width;
    if (pile.row(i) == 0) all.push_back({-1, i, 0, 1});
    if (column + 1 < pile.width && i + 1 < pile.discs) all.push_back({i, i + 1, 1, 0});
    if (i + pile.width < pile.discs) all.push_back({i, i + pile.width, 0.5, height});
    if (column > 0 && i + pile.width - 1 < pile.discs) all.push_back({i, i + pile.width - 1, -0.5, height});
  }
  return all;
}

}  // namespace

GalleryInstance hexagonal_packing(Index discs, double part_at_rest, std::uint32_t seed) {
  Draw draw(seed);
  const Pile pile{discs, static_cast<Index>(std::ceil(std::sqrt(static_cast<double>(discs))))};
  const auto resting = static_cast<Index>(std::lround(part_at_rest * static_cast<double>(pile.rows())));
  Vector weights(2 * discs), q = Vector::Zero(2 * discs), z(2 * discs);
  for (Index i = 0; i < discs; ++i) {
    weights[2 * i] = weights[2 * i + 1] = draw.integer(1, 4);
    q[2 * i + 1] = 2 * static_cast<double>(std::max<Index>(0, pile.row(i) - resting + 1));
  }
  const std::vector<TouchingPair> all = touching_pairs(pile);
  const auto m = static_cast<Index>(all.size());
  std::vector<Eigen::Triplet<double>> entries;
  Vector lambda = Vector::Zero(m);
  z = weights.cwiseProduct(q);
  for (Index a = 0; a < m; ++a) {
    const auto [low, high, nx, ny] = all[at(a)];
    const double apart = ny * (q[2 * high + 1] - (low < 0 ? 0 : q[2 * low + 1]));
    lambda[a] = apart > 0 ? 0 : draw.integer(0, 8);
    const auto add = [&](Index i, double value) {
      if (!(std::abs(value) > 0)) return;
      entries.emplace_back(a, i, value);
      z[i] -= value * lambda[a];
    };
    if (low >= 0) {
      add(2 * low, -nx);
      add(2 * low + 1, -ny);
    }
    add(2 * high, nx);
    add(2 * high + 1, ny);
  }
  SparseRows U(m, 2 * discs);
  U.setFromTriplets(entries.begin(), entries.end());
  return {{Metric::diagonal(weights), z, ConstraintRows(U), Vector::Zero(m), {}},
          true,
          DoubleDoubleVector(q),
          lambda,
          Vector(0)};
}

}  // namespace convex::inline families
