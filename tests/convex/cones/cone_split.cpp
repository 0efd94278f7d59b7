#include "convex/cones/cone_split.hpp"

#include <doctest/doctest.h>

#include "convex/cones/cone_operations.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "tests/convex/cones/random_cone.hpp"
#include "tests/oracles/brute_force_cone.hpp"

using convex::ConeSplit;
using convex::ExactMetric;
using convex::ExactVector;
using convex::Index;
using convex::IntegerVector;
using convex::Matrix;
using convex::PolyhedralCone;
using convex::Vector;
using oracles::FractionRow;
using tests::random_cone;
using tests::random_metric;

namespace {

FractionRow times(const Matrix& W, const FractionRow& x) {
  FractionRow product(x.size(), mpq_class(0));
  for (Index i = 0; i < W.rows(); ++i)
    for (Index j = 0; j < W.cols(); ++j)
      product[static_cast<std::size_t>(i)] += mpq_class(W(i, j)) * x[static_cast<std::size_t>(j)];
  return product;
}

Vector random_point(unsigned seed, Index n) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Vector z(n);
  for (Index i = 0; i < n; ++i)
    z[i] =
        seed % 3 == 0 ? std::round(2 * normal(random)) : std::ldexp(normal(random), seed % 5 == 0 ? 300 : 0);
  return z;
}

}  // namespace

TEST_CASE("the projection is exactly the point that Moreau's characterisation names") {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const Index n = 1 + seed % 6;
    const PolyhedralCone K = random_cone(seed, n);
    const Matrix W = random_metric(seed, n);
    const Vector z = random_point(seed, n);
    const FractionRow x = oracles::fractions(
        convex::proj(K, convex::exact_vector(z), convex::exact_metric(convex::exact_rows(W))));
    FractionRow rest = oracles::fractions(z);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= x[i];
    const FractionRow covector = times(W, rest);
    CAPTURE(seed);
    for (const IntegerVector& a : K.halfspaces) CHECK((oracles::dot(oracles::fractions(a), x) <= 0));
    for (const IntegerVector& e : K.equations) CHECK((oracles::dot(oracles::fractions(e), x) == 0));
    for (const IntegerVector& g : K.generators) CHECK((oracles::dot(oracles::fractions(g), covector) <= 0));
    for (const IntegerVector& b : K.lines) CHECK((oracles::dot(oracles::fractions(b), covector) == 0));
    CHECK((oracles::dot(x, covector) == 0));
  }
}

TEST_CASE("a point is exactly the sum of its projections on a cone and on the polar cone, found apart") {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const Index n = 1 + seed % 7;
    const PolyhedralCone K = random_cone(seed + 700, n);
    const ExactMetric W = convex::exact_metric(convex::exact_rows(random_metric(seed, n)));
    const ExactVector z = convex::exact_vector(random_point(seed, n));
    const ConeSplit found = convex::split(K, convex::polar(K, W), z, W);
    CAPTURE(seed);
    CHECK(found.residual == 0);
    CHECK(found.inner.numerator.is_zero());
    const FractionRow x = oracles::fractions(found.x), y = oracles::fractions(found.y);
    const FractionRow whole = oracles::fractions(z);
    for (std::size_t i = 0; i < whole.size(); ++i)
      CHECK(mpq_class(x[i] + y[i]).get_str() == whole[i].get_str());
    // The faces that the two lie on are at right angles: their dimensions do not add up to more than n.
    CHECK(found.face.dimension + found.polar_face.dimension <= n);
  }
}

TEST_CASE("the exact projection agrees with the nearest-point solver on the half-spaces") {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Index n = 2 + seed % 5;
    const PolyhedralCone K = random_cone(seed + 90, n);
    const convex::Metric W = convex::Metric::dense(random_metric(seed, n));
    const Vector z = random_point(3 * seed, n);
    const convex::IntegerRows& H = K.halfspaces;
    Matrix U(static_cast<Index>(H.size() + K.equations.size()), n);
    U << -convex::nearest_directions(H, n), convex::nearest_directions(K.equations, n);
    std::vector<Index> two_sided;
    for (Index a = static_cast<Index>(H.size()); a < U.rows(); ++a) two_sided.push_back(a);
    const convex::Solution by_rows = convex::active_set(
        {W, W.multiply(z), convex::ConstraintRows(convex::RowMatrix(U)), Vector::Zero(U.rows()), two_sided});
    CAPTURE(seed);
    REQUIRE(by_rows.status == convex::Status::solved);
    CHECK(W.norm(by_rows.q - convex::proj(K, z, W)) <= 1e-12 * W.norm(z));
  }
}

TEST_CASE("a projection on rays that doubles cannot tell apart is right to the last place") {
  // Two rays at an angle of 2^-52 about (1, 1), and a point between them.
  Matrix G(2, 2);
  G << 1, 1, 1, 1 + 0x1p-52;
  const PolyhedralCone K = convex::generated_cone(G);
  Vector z(2);
  z << 1 - 0x1p-53, 1;
  CHECK(convex::proj(K, z, convex::Metric::identity(2)) == z);
  z << -1, 3;
  const Vector x = convex::proj(K, z, convex::Metric::identity(2));
  // On the second ray g: (g·z / g·g) g.
  const mpq_class slope = mpq_class(G(1, 1)), factor = (-1 + 3 * slope) / (1 + slope * slope);
  CHECK(std::abs(mpq_class(factor - x[0]).get_d()) <= 0x1p-53);
  CHECK(std::abs(mpq_class(factor * slope - x[1]).get_d()) <= 0x1p-53);
}

TEST_CASE("a projection refuses sizes that do not fit") {
  const PolyhedralCone K = convex::generated_cone(Matrix::Identity(2, 2));
  CHECK_THROWS_AS(convex::proj(K, Vector(Vector::Zero(3)), convex::Metric::identity(3)),
                  convex::InvalidInput);
  CHECK_THROWS_AS(convex::proj(K, Vector(Vector::Zero(2)), convex::Metric::identity(3)),
                  convex::InvalidInput);
}

TEST_CASE("a split refuses a second cone that is not the polar of the first in its metric") {
  const PolyhedralCone K = convex::generated_cone(Matrix{{1, 0}, {1, 1}});
  const convex::ExactMetric W = convex::exact_metric(convex::exact_rows(Matrix{{2, 1}, {1, 2}}));
  const convex::ExactVector z = convex::exact_vector(Vector{{1, -3}});
  CHECK(convex::split(K, convex::polar(K, W), z, W).inner.numerator == 0);
  CHECK_THROWS_AS(convex::split(K, convex::polar(K), z, W),
                  convex::InvalidInput);  // that of the plain product
  CHECK_THROWS_AS(convex::split(K, K, z, W), convex::InvalidInput);
}
