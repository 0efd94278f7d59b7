#include <doctest/doctest.h>

#include "convex/cones/cone_operations.hpp"
#include "convex/cones/cone_split.hpp"
#include "convex/functions/cones.hpp"

using namespace convex;

TEST_CASE("a polyhedral cone, its polar and the split of a point, all exact") {
  const PolyhedralCone K = generated_cone(Matrix{{1, 0}, {1, 1}, {2, 1}});
  CHECK(K.generators == IntegerRows{{1, 0}, {1, 1}});    // (2, 1) was redundant
  CHECK(K.halfspaces == IntegerRows{{-1, 1}, {0, -1}});  // x_2 <= x_1 and x_2 >= 0
  const PolyhedralCone P = polar(K);                     // {y : x·y <= 0 on K}
  CHECK(P.generators == K.halfspaces);
  CHECK(are_equal(polar(P), K));

  const ConeSplit s = split(K, P, exact_vector(Vector{{1, 3}}), identity_metric(2));
  CHECK(nearest(s.x) == Vector{{2, 2}});  // on the ray of (1, 1)
  CHECK(nearest(s.y) == Vector{{-1, 1}});
  CHECK(s.inner.numerator == 0);  // not nearly: exactly
  CHECK(s.face.dimension == 1);

  // The polar depends on the product. In x·Wy it is W⁻¹ times the plain one.
  const ExactMetric W = exact_metric(exact_rows(Matrix{{2, 1}, {1, 2}}));
  CHECK(polar(K, W).generators == IntegerRows{{-1, 1}, {1, -2}});

  // Cones that are not polyhedral are sets of the catalogue: the indicator's conjugate is that of the polar.
  const Function soc = second_order_cone().indicator;
  const Vector z{{3, 4, 0}};
  const Vector x = soc.prox(z, Metric::identity(3)).x, y = soc.conjugate().prox(z, Metric::identity(3)).x;
  CHECK(x.isApprox(Vector{{1.5, 2, 2.5}}, 1e-15));
  CHECK(y.isApprox(Vector{{1.5, 2, -2.5}}, 1e-15));
}
