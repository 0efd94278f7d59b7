#include <doctest/doctest.h>

#include <array>

#include "convex/functions/norms.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/sets.hpp"
#include "convex/operations/operations.hpp"

using namespace convex;

TEST_CASE("functions are made of functions, and keep an exact prox") {
  const Metric plain = Metric::identity(3);
  const Vector z{{3, -0.25, 0.75}};

  // Soft thresholding held within a box.
  const Function f = sum(std::array{norm1(0.5), indicator(box(0, 2))});
  CHECK(f.prox(z, plain).x == Vector{{2, 0, 0.25}});
  // The sum of piecewise linear-quadratic functions is one: exact in any metric, by the active set.
  const Metric W = Metric::dense(Matrix{{2, 1, 0}, {1, 2, 1}, {0, 1, 2}});
  const Prox p = f.prox(z, W);
  CHECK(p.status == Status::solved);
  CHECK((W.multiply(z - p.x) - p.v).norm() <= 1e-14);
  CHECK(f.is_subgradient(p.v, p.x));

  // Moreau's envelope of |x| is Huber's function.
  CHECK(envelope(norm1(), 0.5)(z) == doctest::Approx(huber(0.5)(z)).epsilon(1e-15));

  // Differences of neighbours through a matrix: total variation.
  const Function tv = precompose(norm1(), Matrix{{-1, 1, 0}, {0, -1, 1}}, Vector::Zero(2));
  CHECK(tv(z) == 4.25);
  CHECK(tv.prox(z, plain).x.isApprox(total_variation().prox(z, plain).x, 1e-14));

  // Conjugates follow by rule: that of a sum is an inf-convolution, that of an inf-convolution a sum.
  CHECK(to_text(translate(norm1(), Vector{{1, 2}}).conjugate().call()) ==
        "tilt(indicator(ball_inf(radius=1)), c=[1,2])");
  CHECK(inf_convolution(norm1(), squared_norm2()).conjugate()(Vector{{1, -1, 0.5}}) == 1.125);
}
