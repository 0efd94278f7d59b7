#include "convex/cones/cone_operations.hpp"

#include <doctest/doctest.h>

#include "convex/invalid_input.hpp"
#include "tests/convex/cones/random_cone.hpp"
#include "tests/oracles/brute_force_cone.hpp"

using convex::ExactMetric;
using convex::Index;
using convex::IntegerVector;
using convex::Matrix;
using convex::PolyhedralCone;
using tests::random_cone;
using tests::random_matrix;
using tests::random_metric;

namespace {

/// x·Wy in fractions, from the doubles of W.
mpq_class product(const Matrix& W, const IntegerVector& x, const IntegerVector& y) {
  mpq_class sum = 0;
  const auto a = oracles::fractions(x), b = oracles::fractions(y);
  for (Index i = 0; i < W.rows(); ++i)
    for (Index j = 0; j < W.cols(); ++j)
      sum += a[static_cast<std::size_t>(i)] * mpq_class(W(i, j)) * b[static_cast<std::size_t>(j)];
  return sum;
}

}  // namespace

TEST_CASE("every member of a cone makes an obtuse angle with every member of its polar, in the metric") {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Index n = 1 + seed % 6;
    const PolyhedralCone K = random_cone(seed, n);
    const Matrix W = random_metric(seed, n);
    const PolyhedralCone P = convex::polar(K, convex::exact_metric(convex::exact_rows(W)));
    CAPTURE(seed);
    CHECK(P.dimension() == n - K.lineality());
    for (const IntegerVector& p : P.generators) {
      for (const IntegerVector& g : K.generators) CHECK((product(W, g, p) <= 0));
      for (const IntegerVector& b : K.lines) CHECK((product(W, b, p) == 0));
    }
    for (const IntegerVector& b : P.lines)
      for (const IntegerVector& g : K.generators) CHECK((product(W, g, b) == 0));
  }
}

TEST_CASE("the polar of the polar is the cone, in any metric, and so is the dual of the dual") {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const Index n = 1 + seed % 7;
    const PolyhedralCone K = random_cone(seed, n);
    const ExactMetric W = convex::exact_metric(convex::exact_rows(random_metric(seed, n)));
    CAPTURE(seed);
    const PolyhedralCone again = convex::polar(convex::polar(K, W), W);
    CHECK(convex::are_equal(K, again));
    CHECK(again.generators == K.generators);
    CHECK(again.lines == K.lines);
    CHECK(again.equations == K.equations);
    CHECK(convex::are_equal(K, convex::dual(convex::dual(K, W), W)));
  }
}

TEST_CASE("a polar's two descriptions are of one cone: found anew from either they agree") {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Index n = 1 + seed % 6;
    const PolyhedralCone P = convex::polar(
        random_cone(seed, n), convex::exact_metric(convex::exact_rows(random_metric(seed + 1, n))));
    const PolyhedralCone generated =
        convex::generated_cone(tests::exact(P.generators), tests::exact(P.lines), n);
    CAPTURE(seed);
    CHECK(generated.generators == P.generators);
    CHECK(generated.equations == P.equations);
    CHECK(generated.halfspaces.size() == P.halfspaces.size());
    CHECK(convex::are_equal(
        generated, convex::halfspace_cone(tests::exact(P.halfspaces), tests::exact(P.equations), n)));
  }
}

TEST_CASE("the polar of a sum is the intersection of the polars, and the other way round") {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const Index n = 1 + seed % 6;
    const PolyhedralCone first = random_cone(seed, n), second = random_cone(seed + 5000, n);
    const ExactMetric W = convex::exact_metric(convex::exact_rows(random_metric(seed, n)));
    CAPTURE(seed);
    const PolyhedralCone both = convex::sum(first, second), common = convex::intersection(first, second);
    CHECK(convex::are_equal(convex::polar(both, W),
                            convex::intersection(convex::polar(first, W), convex::polar(second, W))));
    CHECK(convex::are_equal(convex::polar(common, W),
                            convex::sum(convex::polar(first, W), convex::polar(second, W))));
    CHECK(convex::includes(both, first));
    CHECK(convex::includes(second, common));
  }
}

TEST_CASE("the polar of an image is the preimage of the polar under the transposed matrix") {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const Index n = 1 + seed % 5, m = 1 + (seed / 5) % 5;
    const PolyhedralCone K = random_cone(seed, n);
    const Matrix M = random_matrix(seed, m, n);
    CAPTURE(seed);
    const PolyhedralCone mapped = convex::image(K, convex::exact_rows(M));
    CHECK(convex::are_equal(convex::polar(mapped),
                            convex::preimage(convex::polar(K), convex::exact_rows(Matrix(M.transpose())))));
    CHECK(convex::includes(convex::preimage(mapped, convex::exact_rows(M)), K));
  }
}

TEST_CASE("an exact point is told from one beside it by a last place") {
  Matrix G(2, 2);
  G << 1, 3, 1, 0;
  const PolyhedralCone K = convex::generated_cone(G);
  convex::Vector x(2);
  x << 0.1, 0.3;
  // 0.3 as a double lies below 3/10 and 0.1 above 1/10, so the ratio is below 3.
  CHECK(convex::contains(K, x));
  const std::vector<convex::Fraction> tenths{*convex::read_fraction("0.1"), *convex::read_fraction("0.3")};
  CHECK(convex::contains(K, convex::exact_vector(tenths)));
  x[1] = 0.30000000000000004;
  CHECK(convex::contains(K, x) == (mpq_class(x[1]) <= 3 * mpq_class(x[0])));
  x[1] = 0.3000000000000001;
  CHECK_FALSE(convex::contains(K, x));
}

TEST_CASE("operations refuse sizes that do not fit") {
  const PolyhedralCone plane = convex::generated_cone(Matrix::Identity(2, 2)),
                       space = convex::generated_cone(Matrix::Identity(3, 3));
  CHECK_THROWS_AS(convex::sum(plane, space), convex::InvalidInput);
  CHECK_THROWS_AS(convex::intersection(plane, space), convex::InvalidInput);
  CHECK_THROWS_AS(convex::includes(plane, space), convex::InvalidInput);
  CHECK_THROWS_AS(convex::polar(plane, convex::identity_metric(3)), convex::InvalidInput);
  CHECK_THROWS_AS(convex::image(plane, convex::exact_rows(Matrix::Identity(3, 3))), convex::InvalidInput);
  CHECK_THROWS_AS(convex::preimage(plane, convex::exact_rows(Matrix::Identity(3, 3))), convex::InvalidInput);
  CHECK_THROWS_AS(convex::contains(plane, convex::Vector(convex::Vector::Zero(3))), convex::InvalidInput);
}
