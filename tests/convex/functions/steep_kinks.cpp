#include <doctest/doctest.h>

#include <cmath>

#include "convex/decompositions/cutting_planes.hpp"
#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

/// Where two parts of a maximum meet that are steep beside the covector, an x that is right to 1e-13 leaves
/// 1e-10 of f(x): no more is proved of x than the root of that. The points are of 40 digits, from the
/// equations of the kink.
using namespace convex;

namespace {

const Metric steep_W = Metric::diagonal(Vector{{0.5, 0.03125}});
const Vector far_z{{-60, -50}}, kink_x{{-3.169715270379710031, -2.910970079650468546}};

Function steep() {
  return samples::function(
      "pointwise_max(tilt(max_affine([[1,-3],[0,1]],[1,-3]),[-2,3]),"
      "pointwise_max(squared_distance(ball2(1,[-2,-3]),1024),elastic_net(1,1)))",
      steep_W);
}

}  // namespace

TEST_CASE("the prox at a steep kink is solved, and within its bound") {
  const Decomposition found = decompose(steep(), far_z, steep_W);
  CHECK(found.status == Status::solved);
  CHECK(steep_W.norm(found.x.x - kink_x) <= found.error_bound);
  CHECK(found.error_bound <= 1e-10);
  CHECK(std::abs(found.f_x - 15.341106199979465306) <= 1e-10);
}

TEST_CASE("cuts find where the parts meet beside any point near, and say how far they went") {
  const double stiff = 1e6;  // the curvature is 1024
  for (const double away : {1e-13, 1e-10, -3e-9}) {
    CAPTURE(away);
    Prox near;
    near.x = kink_x + Vector{{away, 0.3 * away}};
    near.v = steep_W.multiply(far_z - kink_x);
    near.error_bound = 2 * std::abs(away);
    const auto found = at_kink(steep(), near, far_z, steep_W, stiff, Look{});
    REQUIRE(found);
    const double x = found->x[0], y = found->x[1];
    const double ball = 512 * std::pow(std::hypot(x + 2, y + 3) - 1, 2);
    const double net = std::abs(x) + std::abs(y) + (x * x + y * y) / 2;
    CHECK(std::abs(ball - net) <= 1e-12);
    CHECK((found->x - kink_x).norm() <= 8 * std::abs(away));
    CHECK(found->error_bound >= steep_W.norm(found->x - kink_x));
  }
}
