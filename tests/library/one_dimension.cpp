#include <doctest/doctest.h>

#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/elementary.hpp"
#include "convex/piecewise/pieces.hpp"

using namespace convex;

TEST_CASE("piecewise linear-quadratic functions of one variable are a closed algebra") {
  const PiecewiseQuadratic f = piecewise::absolute(), g = piecewise::quadratic(1);  // |x| and x²/2

  // The smallest of |u| + (x - u)²/2 over u is Huber's function.
  const Pieces huber = pieces(inf_convolution(f, g));
  CHECK(huber.breaks == Vector{{-1, 1}});
  CHECK(huber.coefficients == Matrix{{0, -1, -0.5}, {1, 0, 0}, {0, 1, -0.5}});  // rows c2, c1, c0
  CHECK(pieces(envelope(f, 1)).coefficients == huber.coefficients);

  // Its conjugate is the sum of the conjugates: y²/2 on [-1, 1].
  const PiecewiseQuadratic dual = sum(conjugate(f), conjugate(g));
  CHECK(dual(0.5) == 0.125);
  CHECK(domain(dual).low == -1);
  CHECK(domain(dual).high == 1);
  CHECK(pieces(conjugate(dual)).coefficients == huber.coefficients);

  // max(|x - 1|, 2 - x): a kink where the two cross.
  const PiecewiseQuadratic top = pointwise_max(translate(f, 1), tilt(piecewise::constant(2), -1));
  CHECK(top(0) == 2);
  CHECK(minimizers(top)->low == 1.5);
  CHECK(infimum(top) == 0.5);
  CHECK(subdifferential(top, 1.5)->low == -1);
  CHECK(subdifferential(top, 1.5)->high == 1);
}
