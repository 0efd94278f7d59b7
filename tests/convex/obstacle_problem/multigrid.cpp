#include "convex/obstacle_problem/grid_multigrid.hpp"

#include <doctest/doctest.h>

#include <functional>

using convex::GridMultigrid;
using convex::GridOperator;
using convex::Index;
using convex::Vector;

namespace {

/// A place in the square [-1, 1]².
using FreePart = std::function<bool(double x, double y)>;

/// V-cycles to 1e-4 of the energy norm for a load of 1 on the free points of a square grid.
Index cycles(Index side, const FreePart& is_free) {
  const GridOperator A{side, side};
  Vector free = A.field(), u;
  const auto place = [&](Index i) {
    return 2 * static_cast<double>(i + 1) / static_cast<double>(side + 1) - 1;
  };
  for (Index j = 0; j < side; ++j)
    for (Index i = 0; i < side; ++i) free[A.at(i, j)] = is_free(place(i), place(j)) ? 1 : 0;
  GridMultigrid multigrid(A);
  multigrid.set_free(free);
  multigrid.solve(free, 1e-4, u);
  return multigrid.steps();
}

bool everywhere(double, double) { return true; }

}  // namespace

TEST_CASE("an edge that lies off the coarse grids costs multigrid a cycle at most") {
  for (Index side : {63, 127, 255}) {  // edges of all grids coincide
    CAPTURE(side);
    const Index aligned = cycles(side, everywhere);
    CHECK(cycles(side + 1, everywhere) <= aligned + 1);
    CHECK(cycles(side + 2, everywhere) <= aligned + 1);
    CHECK(cycles(side + 37, everywhere) <= aligned + 1);
  }
}

TEST_CASE(
    "a free part with edges between the points of coarse grids costs a cycle more than a whole grid of any "
    "size") {
  const FreePart parts[] = {[](double x, double y) { return x * x + y * y < 0.64; },
                            [](double x, double y) { return x * x + y * y > 0.16; },
                            [](double x, double y) { return std::abs(x + 0.3 * y) > 0.2; }};
  for (Index side : {63, 128, 255, 512})
    for (const FreePart& part : parts) {
      CAPTURE(side);
      CHECK(cycles(side, part) <= cycles(side, everywhere) + 1);
    }
}
