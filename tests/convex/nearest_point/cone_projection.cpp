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

TEST_CASE("generators of any length span the cone that those of length 1 span") {
  std::mt19937 draw(1966);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 40; ++round) {
    const Matrix V = Matrix::NullaryExpr(3, 5, [&] { return normal(draw); });
    const Vector b = Vector::NullaryExpr(3, [&] { return normal(draw); });
    const std::vector<Index> free = round % 2 == 0 ? std::vector<Index>{1} : std::vector<Index>{};
    const convex::ConeProjection plain = convex::cone_projection(V, b, free);
    const Vector power{{-531, 700, 0, -1020, 481}};  // powers of 2: nothing is rounded
    Matrix far = V;
    for (Index a = 0; a < 5; ++a)
      far.col(a) = V.col(a).unaryExpr([&](double v) { return std::ldexp(v, static_cast<int>(power[a])); });
    const convex::ConeProjection found = convex::cone_projection(far, b, free);
    REQUIRE(plain.finished);
    REQUIRE(found.finished);
    CHECK((found.point - plain.point).norm() <= 1e-14 * b.norm());
    for (Index a = 0; a < 5; ++a)
      CHECK(std::ldexp(found.lambda[a], static_cast<int>(power[a])) ==
            doctest::Approx(plain.lambda[a]).epsilon(1e-12));
  }
}
