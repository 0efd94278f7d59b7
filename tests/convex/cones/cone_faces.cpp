#include "convex/cones/cone_faces.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "convex/cones/cone_operations.hpp"
#include "tests/convex/cones/random_cone.hpp"
#include "tests/oracles/brute_force_cone.hpp"

using convex::ConeFace;
using convex::Index;
using convex::IntegerVector;
using convex::Matrix;
using convex::PolyhedralCone;
using tests::random_cone;

namespace {

Index binomial(Index n, Index k) { return k == 0 ? 1 : binomial(n, k - 1) * (n - k + 1) / k; }

/// The faces as the sets of generators that are on every one of some half-spaces, all choices tried.
std::set<std::vector<Index>> faces_by_all_choices(const PolyhedralCone& K) {
  std::set<std::vector<Index>> found;
  for (std::size_t choice = 0; choice < std::size_t{1} << K.halfspaces.size(); ++choice) {
    std::vector<Index> members;
    for (std::size_t k = 0; k < K.generators.size(); ++k) {
      bool on_all = true;
      for (std::size_t h = 0; h < K.halfspaces.size(); ++h)
        on_all =
            on_all && (((choice >> h) & 1U) == 0 || oracles::dot(oracles::fractions(K.halfspaces[h]),
                                                                 oracles::fractions(K.generators[k])) == 0);
      if (on_all) members.push_back(static_cast<Index>(k));
    }
    found.insert(members);
  }
  return found;
}

Index rank_of(const PolyhedralCone& K, const std::vector<Index>& generators) {
  std::vector<oracles::FractionRow> rows;
  for (const IntegerVector& b : K.lines) rows.push_back(oracles::fractions(b));
  for (Index k : generators) rows.push_back(oracles::fractions(K.generators[static_cast<std::size_t>(k)]));
  return static_cast<Index>(oracles::rank(rows));
}

}  // namespace

TEST_CASE("the faces are the intersections of facets, each with its dimension") {
  for (unsigned seed = 0; seed < 120; ++seed) {
    const PolyhedralCone K = random_cone(seed, 1 + seed % 5);
    if (K.halfspaces.size() > 9) continue;
    CAPTURE(seed);
    std::set<std::vector<Index>> found;
    std::size_t count = 0;
    for (const auto& same_dimension : convex::faces(K))
      for (const ConeFace& face : same_dimension) {
        found.insert(face.generators);
        ++count;
        CHECK(face.dimension == rank_of(K, face.generators));
      }
    CHECK(found == faces_by_all_choices(K));
    CHECK(count == found.size());
  }
}

TEST_CASE("orthants, cones over cubes and over cross-polytopes have their known f-vectors") {
  for (Index n = 1; n <= 7; ++n) {
    const std::vector<Index> orthant = convex::f_vector(convex::generated_cone(Matrix::Identity(n, n)));
    for (Index k = 0; k <= n; ++k) CHECK(orthant[static_cast<std::size_t>(k)] == binomial(n, k));
    Matrix corners(Index{1} << (n - 1), n);
    for (Index i = 0; i < corners.rows(); ++i)
      for (Index k = 0; k < n; ++k) corners(i, k) = k == n - 1 || ((i >> k) & 1) != 0 ? 1 : -1;
    const std::vector<Index> cube = convex::f_vector(convex::generated_cone(corners)),
                             cross = convex::f_vector(convex::halfspace_cone(corners));
    CHECK(cube.front() == 1);
    for (Index k = 1; k <= n; ++k) {
      const Index expected = binomial(n - 1, k - 1) << (n - k);
      CHECK(cube[static_cast<std::size_t>(k)] == expected);
      if (n > 1) CHECK(cross[static_cast<std::size_t>(n - k)] == expected);
    }
  }
}

TEST_CASE("Euler's relation holds for the faces of a cone that is no subspace") {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const PolyhedralCone K = random_cone(seed + 300, 2 + seed % 6);
    if (K.generators.empty()) continue;
    CAPTURE(seed);
    Index alternating = 0, sign = 1;
    for (Index count : convex::f_vector(K)) {
      alternating += sign * count;
      sign = -sign;
    }
    CHECK(alternating == 0);
  }
}

TEST_CASE("the face of a point is the one spanned by what the point is a sum of") {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const PolyhedralCone K = random_cone(seed, 1 + seed % 6);
    for (const auto& same_dimension : convex::faces(K))
      for (const ConeFace& face : same_dimension) {
        IntegerVector x(static_cast<std::size_t>(K.n), 0);
        for (Index k : face.generators)
          for (std::size_t i = 0; i < x.size(); ++i) x[i] += K.generators[static_cast<std::size_t>(k)][i];
        const auto found = convex::face_of(K, {x, 7});
        CAPTURE(seed);
        REQUIRE(found);
        CHECK(found->generators == face.generators);
        CHECK(found->halfspaces == face.halfspaces);
        CHECK(found->dimension == face.dimension);
      }
    for (const IntegerVector& a : K.halfspaces) CHECK_FALSE(convex::face_of(K, {a, 1}));
  }
}
