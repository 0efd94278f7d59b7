#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "convex/other_pairs.hpp"
#include "tests/convex/operations/samples.hpp"

/// Where two parts of a maximum meet that are steep beside the covector, an x that is right to 1e-13 leaves
/// 1e-10 of f(x): no more is proved of x than the root of that. The points are of 40 digits, from the
/// equations of the kink.
using namespace convex;

namespace {

const Metric W = Metric::diagonal(Vector{{0.5, 0.03125}});
const Vector z{{-60, -50}}, x{{-3.169715270379710031, -2.910970079650468546}};

Function steep() {
  return samples::function(
      "pointwise_max(tilt(max_affine([[1,-3],[0,1]],[1,-3]),[-2,3]),"
      "pointwise_max(squared_distance(ball2(1,[-2,-3]),1024),elastic_net(1,1)))",
      W);
}

}  // namespace

TEST_CASE("the prox at a steep kink is right to roundings of x") {
  const Decomposition found = decompose(steep(), z, W);
  CHECK(found.status == Status::solved);
  CHECK((found.x.x - x).norm() <= 8 * unit_roundoff * x.norm());
  CHECK(std::abs(found.f_x - 15.341106199979465306) <= 1e-12);
}

TEST_CASE("cuts find the kink from any point near it, and say how far they went") {
  for (const double away : {1e-13, 1e-10, -3e-9}) {
    CAPTURE(away);
    const Prox near{
        .x = x + Vector{{away, 0.3 * away}}, .v = W.multiply(z - x), .error_bound = 2 * std::abs(away)};
    const auto found = at_kink(steep(), near, z, W, Look{});
    REQUIRE(found);
    CHECK((found->x - x).norm() <= 16 * unit_roundoff * z.norm());
    CHECK(found->error_bound >= near.error_bound);
  }
}
