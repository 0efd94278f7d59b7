#include <algorithm>
#include <cmath>

#include "convex/nearest_point/gallery/families.hpp"
#include "convex/nearest_point/gallery/planted.hpp"

namespace convex::inline families {
namespace {

/// Coordinate 1 stands apart in A and in all other rows, and q is 0 there: what the small angle multiplies
/// is added to nothing, so no bit is lost however small it is.
constexpr Index apart = 1;

Matrix inertia(Index n, Draw& draw) {
  Matrix A = integer_inertia(n, draw);
  const double own = A(apart, apart);
  A.row(apart).setZero();
  A.col(apart).setZero();
  A(apart, apart) = own;
  return A;
}

void without_apart(Vector& u) { u[apart] = 0; }

GalleryInstance pair(Index n, double angle, std::uint32_t seed, bool opposite) {
  Draw draw(seed);
  const Matrix A = inertia(n, draw);
  Vector q = draw.integers(n, -8, 8);
  without_apart(q);
  PlantedRows rows(A, q);
  Vector u = integer_row(n, draw);
  without_apart(u);
  u[0] = 1;
  const double tilt = std::ldexp(1.0, static_cast<int>(std::lround(std::log2(angle))));
  Vector twin = opposite ? Vector(-u) : u;
  twin[apart] = tilt;
  // The multipliers at a flat vertex cancel but for their tilted part, which is to count.
  const double multiplier = opposite ? draw.integer(1, 8) / tilt : draw.integer(1, 8);
  rows.add(u, opposite ? multiplier : draw.integer(1, 8), 0);
  rows.add(twin, multiplier, 0);
  const auto add_rows = [&](Index count, bool loaded) {
    for (Index a = 0; a < count; ++a) {
      Vector v = integer_row(n, draw);
      without_apart(v);
      rows.add(v, loaded ? draw.integer(1, 8) : 0, loaded ? 0 : draw.integer(1, 8));
    }
  };
  add_rows(std::max<Index>(0, n / 4 - 1), true);
  add_rows(n, false);
  return rows.instance(draw);
}

}  // namespace

GalleryInstance near_parallel(Index n, double angle, std::uint32_t seed) {
  return pair(n, angle, seed, false);
}

GalleryInstance near_opposite(Index n, double angle, std::uint32_t seed) {
  return pair(n, angle, seed, true);
}

}  // namespace convex::inline families
