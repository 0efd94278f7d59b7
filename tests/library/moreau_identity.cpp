#include <doctest/doctest.h>

#include "convex/functions/decomposition.hpp"
#include "convex/functions/separable_functions.hpp"

using namespace convex;

TEST_CASE("a point is the sum of two proxes, and f(x) + g(y) = (x|y)") {
  const Function f = logistic();  // Σ log(1 + e^x)
  const Metric W = Metric::dense(Matrix{{3, 1, 0}, {1, 2, -1}, {0, -1, 4}});
  const Vector z{{1, -2, 5}};

  const Decomposition d = decompose(f, z, W);
  CHECK((d.x.x + d.y.x - z).norm() <= 1e-14 * z.norm());  // y is computed as a prox of g, never as z - x
  CHECK(std::abs(d.f_x + d.g_y - d.inner) <= 1e-14 * d.f_x);
  CHECK(d.status == Status::solved);
  CHECK(d.error_bound <= 1e-12);

  // The same by hand.
  const Function g = f.conjugate(W);  // g(y) = sup over x of (x|y) - f(x)
  const Vector x = f.prox(z, W).x, y = g.prox(z, W).x;
  CHECK((x + y - z).norm() <= 1e-14 * z.norm());
  CHECK(f(x) + g(y) == doctest::Approx(W.inner(x, y)).epsilon(1e-13));
  // Another split does not satisfy it: conjugacy is missed by at least the square of the distance.
  const Vector off{{1e-3, 0, 0}};
  CHECK(f(x + off) + g(y - off) - W.inner(x + off, y - off) >= 0.99 * W.inner(off, off));
}
