#include "convex/cones/polyhedral_cone.hpp"

#include <doctest/doctest.h>

#include "convex/cones/cone_operations.hpp"
#include "convex/invalid_input.hpp"
#include "tests/convex/cones/random_cone.hpp"
#include "tests/oracles/brute_force_cone.hpp"

using convex::Index;
using convex::IntegerRows;
using convex::IntegerVector;
using convex::Matrix;
using convex::PolyhedralCone;
using oracles::FractionRow;
using tests::ConeData;
using tests::random_cone_data;

namespace {

std::vector<FractionRow> vectors_of(const ConeData& data) {
  std::vector<FractionRow> vectors;
  for (Index i = 0; i < data.generators.rows(); ++i)
    vectors.push_back(oracles::fractions(convex::Vector(data.generators.row(i))));
  for (Index i = 0; i < data.lines.rows(); ++i)
    for (double sign : {1.0, -1.0})
      vectors.push_back(oracles::fractions(convex::Vector(sign * data.lines.row(i))));
  return vectors;
}

std::vector<FractionRow> rows_of(const IntegerRows& first, const IntegerRows& second = {}) {
  std::vector<FractionRow> rows;
  for (const IntegerVector& v : first) rows.push_back(oracles::fractions(v));
  for (const IntegerVector& v : second) rows.push_back(oracles::fractions(v));
  return rows;
}

/// Whether the half-space is a facet's: its generators and the lines have one dimension less than the cone.
bool is_facet(const PolyhedralCone& K, const IntegerVector& a) {
  std::vector<FractionRow> on = rows_of(K.lines);
  for (const IntegerVector& g : K.generators)
    if (oracles::dot(oracles::fractions(a), oracles::fractions(g)) == 0) on.push_back(oracles::fractions(g));
  return static_cast<Index>(oracles::rank(on)) == K.dimension() - 1;
}

Matrix cube(Index n) {
  Matrix corners(Index{1} << (n - 1), n);
  for (Index i = 0; i < corners.rows(); ++i)
    for (Index k = 0; k < n; ++k) corners(i, k) = k == n - 1 || ((i >> k) & 1) != 0 ? 1 : -1;
  return corners;
}

/// Points (t, t², …) of the moment curve at height 1: a cyclic polytope's corners.
Matrix moment_curve(Index n, Index points) {
  Matrix corners(points, n);
  for (Index i = 0; i < points; ++i) {
    corners(i, n - 1) = 1;
    for (Index k = 0; k < n - 1; ++k)
      corners(i, k) = std::pow(static_cast<double>(i - points / 2), static_cast<double>(k + 1));
  }
  return corners;
}

}  // namespace

TEST_CASE("a cone's two descriptions hold the same points as its generators do by Caratheodory's theorem") {
  for (unsigned seed = 0; seed < 150; ++seed) {
    const Index n = 1 + seed % 4;
    const ConeData data = random_cone_data(seed, n);
    const PolyhedralCone K = convex::generated_cone(data.generators, data.lines);
    std::mt19937 random(seed);
    std::vector<FractionRow> points;
    std::vector<bool> by_halfspaces;
    for (int p = 0; p < 12; ++p) {
      convex::Vector x(n);
      for (Index i = 0; i < n; ++i) x[i] = std::uniform_int_distribution<int>(-2, 2)(random);
      // Sums of two generators meet the boundary more often than chance does.
      if (p % 2 == 0 && data.generators.rows() > 1)
        x = data.generators.row(p % data.generators.rows()) +
            data.generators.row((p + 1) % data.generators.rows());
      points.push_back(oracles::fractions(x));
      by_halfspaces.push_back(convex::contains(K, x));
    }
    CAPTURE(seed);
    CHECK(by_halfspaces == oracles::in_cone(vectors_of(data), points));
    std::vector<FractionRow> found = rows_of(K.generators, K.lines);
    for (const FractionRow& line : rows_of(K.lines)) {
      found.push_back(line);
      for (mpq_class& entry : found.back()) entry = -entry;
    }
    CHECK(by_halfspaces == oracles::in_cone(found, points));
  }
}

TEST_CASE("the descriptions are minimal: no row can be spared, and none is missing") {
  for (unsigned seed = 0; seed < 300; ++seed) {
    const Index n = 1 + seed % 5;
    const ConeData data = random_cone_data(seed + 1000, n);
    const PolyhedralCone K = convex::generated_cone(data.generators, data.lines);
    CAPTURE(seed);
    CHECK(K.dimension() == static_cast<Index>(oracles::rank(vectors_of(data))));
    CHECK(K.equations.size() == static_cast<std::size_t>(n) - oracles::rank(vectors_of(data)));
    CHECK(oracles::rank(rows_of(K.lines)) == K.lines.size());
    CHECK(K.lines.size() == static_cast<std::size_t>(n) - oracles::rank(rows_of(K.halfspaces, K.equations)));
    for (const IntegerVector& a : K.halfspaces) CHECK(is_facet(K, a));
    for (std::size_t i = 0; i < K.halfspaces.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        IntegerRows pair = K.equations;
        pair.push_back(K.halfspaces[i]);
        pair.push_back(K.halfspaces[j]);
        CHECK(
            ((oracles::rank(rows_of(pair)) == K.equations.size() + 2) || K.dimension() - K.lineality() == 1));
      }
    // A generator is a facet's normal of the polar.
    for (const IntegerVector& g : K.generators) CHECK(is_facet(convex::polar(K), g));
  }
}

TEST_CASE("generators keep their order and their rows, made primitive") {
  Matrix G(6, 3);
  G << 0, 4, 0, 0, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 0.5, 0.5, 0.25;
  const PolyhedralCone K = convex::generated_cone(G);
  CHECK(K.generators == IntegerRows{{0, 1, 0}, {1, 0, 0}, {2, 2, 1}});
}

TEST_CASE("a cone found from the half-spaces of another is that cone") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const ConeData data = random_cone_data(seed + 2000, 1 + seed % 6);
    const PolyhedralCone K = convex::generated_cone(data.generators, data.lines);
    const PolyhedralCone again =
        convex::halfspace_cone(tests::exact(K.halfspaces), tests::exact(K.equations), K.n);
    CAPTURE(seed);
    CHECK(convex::are_equal(K, again));
    CHECK(again.halfspaces == K.halfspaces);
    CHECK(again.lines == K.lines);
    CHECK(again.equations == K.equations);
    CHECK(again.generators.size() == K.generators.size());
  }
}

TEST_CASE("known cones have their known numbers of facets") {
  for (Index n = 2; n <= 8; ++n) {
    CAPTURE(n);
    const PolyhedralCone orthant = convex::generated_cone(Matrix::Identity(n, n));
    CHECK(orthant.halfspaces.size() == static_cast<std::size_t>(n));
    CHECK(convex::are_equal(orthant, convex::dual(orthant, convex::identity_metric(n))));
    const PolyhedralCone over_cube = convex::generated_cone(cube(n));
    CHECK(over_cube.generators.size() == std::size_t{1} << (n - 1));
    CHECK(over_cube.halfspaces.size() == 2 * static_cast<std::size_t>(n - 1));
    const PolyhedralCone over_cross_polytope = convex::halfspace_cone(cube(n));
    CHECK(over_cross_polytope.generators.size() == 2 * static_cast<std::size_t>(n - 1));
    CHECK(over_cross_polytope.halfspaces.size() == std::size_t{1} << (n - 1));
  }
  // Facets of cyclic polytopes (Gale 1963): C(m, D) in dimension 2k has m/(m-k) C(m-k, k), in 2k+1 it has
  // 2 C(m-k-1, k).
  CHECK(convex::generated_cone(moment_curve(3, 12)).halfspaces.size() == 12);
  CHECK(convex::generated_cone(moment_curve(4, 12)).halfspaces.size() == 20);
  CHECK(convex::generated_cone(moment_curve(5, 12)).halfspaces.size() == 54);
  CHECK(convex::generated_cone(moment_curve(6, 12)).halfspaces.size() == 72);
  CHECK(convex::generated_cone(moment_curve(7, 12)).halfspaces.size() == 112);
  CHECK(convex::generated_cone(moment_curve(8, 12)).halfspaces.size() == 112);
}

TEST_CASE("nothing, everything, a ray, a line and a plane are cones") {
  const PolyhedralCone zero = convex::generated_cone(convex::ExactRows{}, {}, 3);
  CHECK(zero.is_zero());
  CHECK(zero.equations.size() == 3);
  CHECK(zero.is_pointed());
  CHECK(convex::generated_cone(Matrix::Zero(2, 3)).is_zero());
  const PolyhedralCone whole = convex::halfspace_cone(convex::ExactRows{}, {}, 3);
  CHECK(whole.is_full());
  CHECK(whole.lineality() == 3);
  Matrix simplex(4, 3);
  simplex << 1, 0, 0, 0, 1, 0, 0, 0, 1, -1, -1, -1;
  CHECK(convex::are_equal(convex::generated_cone(simplex), whole));
  Matrix ray(2, 2);
  ray << 1, 2, 2, 4;
  CHECK(convex::generated_cone(ray).generators == IntegerRows{{1, 2}});
  CHECK(convex::generated_cone(ray).equations == IntegerRows{{2, -1}});
  CHECK(convex::generated_cone(ray).halfspaces.size() == 1);
  ray.row(1) *= -1;
  CHECK(convex::generated_cone(ray).lines == IntegerRows{{1, 2}});
  CHECK(convex::generated_cone(ray).halfspaces.empty());
  CHECK(convex::generated_cone(Matrix::Constant(1, 1, -3.0)).halfspaces == IntegerRows{{1}});
}

TEST_CASE("doubles are taken at their exact value: a generator off a facet by the last place is seen") {
  Matrix G(4, 3);
  G << 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.1, 0.2, -0x1p-60;
  CHECK(convex::generated_cone(G).generators.size() == 4);
  G(3, 2) = 0x1p-60;
  CHECK(convex::generated_cone(G).generators.size() == 3);
  G(3, 2) = 0x1p-1000;
  G(2, 2) = 0x1p+1000;
  CHECK(convex::generated_cone(G).generators.size() == 3);
  G(3, 2) = -0x1p-1000;
  CHECK(convex::generated_cone(G).halfspaces.size() == 4);
}

TEST_CASE("rows that do not fit and numbers that are none are refused") {
  CHECK_THROWS_AS(convex::generated_cone(Matrix::Ones(1, 2), Matrix::Ones(1, 3)), convex::InvalidInput);
  CHECK_THROWS_AS(convex::generated_cone(Matrix(0, 0)), convex::InvalidInput);
  CHECK_THROWS_AS(convex::generated_cone(Matrix::Constant(1, 2, std::numeric_limits<double>::infinity())),
                  convex::InvalidInput);
  CHECK_THROWS_AS(convex::exact_metric(convex::exact_rows(Matrix::Ones(2, 2))), convex::InvalidInput);
  Matrix W(2, 2);
  W << 2, 1, 0, 2;
  CHECK_THROWS_AS(convex::exact_metric(convex::exact_rows(W)), convex::InvalidInput);
}
