#include <doctest/doctest.h>

#include "convex/grid/legendre_transform.hpp"

using namespace convex;

TEST_CASE("the Legendre transform of a sampled function, in linear time") {
  // f(x) = x_1²/2 + |x_2| on [-2, 2]², in steps of 1/64. Its conjugate there: v_1²/2 + 2 max(0, |v_2| - 1)
  // for |v_1| <= 2.
  const Vector axis = Vector::LinSpaced(257, -2, 2);
  const GridFunction f =
      sample([](const Vector& x) { return x[0] * x[0] / 2 + std::abs(x[1]); }, {axis, axis});

  const Vector slopes = Vector::LinSpaced(9, -2, 2);
  const GridFunction g = conjugate(f, {slopes, slopes});
  double worst = 0;
  for (Index i = 0; i < slopes.size(); ++i)
    for (Index j = 0; j < slopes.size(); ++j) {
      const double expected = slopes[i] * slopes[i] / 2 + 2 * std::max(0.0, std::abs(slopes[j]) - 1);
      worst = std::max(worst, std::abs(g(i, j) - expected));
    }
  CHECK(worst <= 1e-15);  // these slopes have their maximisers on the grid; elsewhere h²/8 is missing at most

  // The envelope of |x| in one dimension is Huber's function.
  const GridFunction h =
      envelope(sample([](const Vector& x) { return std::abs(x[0]); }, {axis}), 0.5, {axis});
  for (Index i = 0; i < axis.size(); ++i) {
    const double x = std::abs(axis[i]), huber = x <= 0.5 ? x * x : x - 0.25;
    CHECK(std::abs(h(i) - huber) <= 1e-4);
  }
}
