#include "convex/nearest_point/cone_projection.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/nearest_point/active_set/active_set.hpp"

using convex::Index;
using convex::Matrix;
using convex::Vector;

TEST_CASE(
    "a point is the orthogonal sum of its projections on a cone and on the polar cone, found by two "
    "methods") {
  std::mt19937 generator(4);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 200; ++trial) {
    const Index n = 1 + trial % 9, m = 1 + (trial * 5) % 17;
    Matrix V(n, m);
    Vector b(n);
    for (Index i = 0; i < V.size(); ++i)
      V.data()[i] = trial % 4 == 0 ? std::round(normal(generator)) : normal(generator);
    for (Index i = 0; i < n; ++i) b[i] = normal(generator);
    CAPTURE(trial);
    const convex::ConeProjection on_cone = convex::cone_projection(V, b, {});
    REQUIRE(on_cone.finished);
    // The polar cone {y : v_a·y <= 0} by the dual active-set method: another route.
    const convex::NearestPointProblem polar{convex::Metric::identity(n),
                                            b,
                                            convex::ConstraintRows(convex::RowMatrix(-V.transpose())),
                                            Vector::Zero(m),
                                            {}};
    const convex::Solution on_polar = convex::active_set(polar);
    REQUIRE(on_polar.status == convex::Status::solved);
    CHECK((on_cone.point + on_polar.q - b).norm() <= 1e-12 * b.norm());
    CHECK(std::abs(on_cone.point.dot(on_polar.q)) <= 1e-12 * b.squaredNorm());
    CHECK((V * on_cone.lambda - on_cone.point).norm() <= 1e-9 * b.norm());
    CHECK(on_cone.lambda.minCoeff() >= 0);
  }
}
