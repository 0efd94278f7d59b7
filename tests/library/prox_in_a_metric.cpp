#include <doctest/doctest.h>

#include "convex/functions/piecewise_functions.hpp"

using namespace convex;

TEST_CASE("a prox in a metric that couples the entries") {
  const Function f = norm1();                              // |x_1| + |x_2|
  const Metric W = Metric::dense(Matrix{{2, 1}, {1, 2}});  // (x|y) = x·Wy
  const Vector z{{3, -0.5}};

  const Prox p = f.prox(z, W);  // the x that minimises ½||x - z||_W² + f(x)
  CHECK(p.x.isApprox(Vector{{2.25, 0}}, 1e-15));
  CHECK(p.v.isApprox(Vector{{1, -0.25}}, 1e-15));  // W(z - x), a subgradient of f at x: a covector
  CHECK(f.is_subgradient(p.v, p.x));
  CHECK(p.status == Status::solved);
  CHECK(p.error_bound <= 1e-14);  // on ||x - x*||_W, measured on this very result

  // In the plain metric each entry goes by itself.
  CHECK(f.prox(z, Metric::identity(2)).x == Vector{{2, 0}});
  // A step is a metric: the prox of 2f in W is that of f in W/2.
  CHECK(f.prox(z, W.scaled(0.5)).x.isApprox(Vector{{1.75, 0}}, 1e-15));
  CHECK(f.prox(z, W.scaled(0.5)).x.isApprox(norm1(2).prox(z, W).x, 1e-15));
}
