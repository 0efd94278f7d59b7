#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "convex/functions/norms.hpp"
#include "convex/functions/quadratic.hpp"
#include "convex/functions/separable_functions.hpp"

using namespace convex;

TEST_CASE("a conjugate is an expression, and it has values") {
  const Function f = norm2(2);
  const Function g = f.conjugate();  // g(v) = sup over x of v·x - f(x)
  CHECK(to_text(g.call()) == "indicator(ball2(radius=2))");
  CHECK(g(Vector{{1, 1}}) == 0);
  CHECK(g(Vector{{3, 0}}) == std::numeric_limits<double>::infinity());
  CHECK(to_text(g.conjugate().call()) == "norm2(weight=2)");

  // ½ x·Qx + c·x has the conjugate ½ (v - c)·Q⁻¹(v - c).
  const Function q = quadratic(Matrix{{2, 0}, {0, 4}}, Vector{{1, 0}});
  CHECK(q.conjugate()(Vector{{3, 4}}) == doctest::Approx(3).epsilon(1e-15));

  // Fenchel: f(x) + f*(v) >= v·x, with equality where v is a subgradient at x. For x log x that is 1 + log x.
  const Vector x{{0.5, 2, 1}};
  const Vector v = *entropy().subgradient(x);
  CHECK(v[1] == doctest::Approx(1 + std::log(2)).epsilon(1e-15));
  CHECK(entropy()(x) + entropy().conjugate()(v) == doctest::Approx(v.dot(x)).epsilon(1e-15));
  CHECK(entropy()(x) + entropy().conjugate()(Vector::Zero(3)) > 0);

  // In the product of a metric the conjugate is g(y) = f*(Wy).
  const Metric W = Metric::diagonal(Vector{{4, 1}});
  CHECK(f.conjugate(W)(Vector{{0.5, 0}}) == 0);
  CHECK(f.conjugate(W)(Vector{{0.6, 0}}) == std::numeric_limits<double>::infinity());
}
