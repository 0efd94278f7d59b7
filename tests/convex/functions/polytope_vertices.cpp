#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "convex/functions/norms.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/sets.hpp"

using convex::Function;
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::Set;
using convex::Vector;

namespace {

/// A polytope with all its vertices as columns, the oracle: its support function is their maximum, and x is
/// the projection of z exactly when x is in it and no vertex is on the other side of x, seen from z.
struct Polytope {
  std::string name;
  Set set;
  Function support;  ///< under the name that the language has for it
  Matrix vertices;
};

/// All x whose entries are taken from `values`.
Matrix grid(Index n, const std::vector<double>& values) {
  Index count = 1;
  for (Index i = 0; i < n; ++i) count *= static_cast<Index>(values.size());
  Matrix points(n, count);
  for (Index k = 0; k < count; ++k)
    for (Index i = 0, rest = k; i < n; ++i, rest /= static_cast<Index>(values.size()))
      points(i, k) = values[static_cast<std::size_t>(rest % static_cast<Index>(values.size()))];
  return points;
}

Matrix columns_with_sum(const Matrix& points, double sum) {
  std::vector<Index> kept;
  for (Index k = 0; k < points.cols(); ++k)
    if (points.col(k).sum() == sum) kept.push_back(k);
  return points(Eigen::all, kept);
}

/// All permutations of w with all signs.
Matrix signed_permutations(Vector w) {
  std::sort(w.begin(), w.end());
  std::vector<Vector> all;
  const Matrix signs = grid(w.size(), {-1, 1});
  do
    for (Index k = 0; k < signs.cols(); ++k) all.push_back(w.cwiseProduct(signs.col(k)));
  while (std::next_permutation(w.begin(), w.end()));
  Matrix vertices(w.size(), static_cast<Index>(all.size()));
  for (std::size_t k = 0; k < all.size(); ++k) vertices.col(static_cast<Index>(k)) = all[k];
  return vertices;
}

std::vector<Polytope> polytopes() {
  constexpr Index n = 4;
  const Matrix unit = Matrix::Identity(n, n);
  Matrix cross(n, 2 * n), differences = Matrix::Zero(n, n - 1);
  cross << 1.5 * unit, -1.5 * unit;
  for (Index i = 0; i + 1 < n; ++i) {
    differences(i, i) = -0.75;
    differences(i + 1, i) = 0.75;
  }
  const Vector weights = Eigen::Vector4d(2, 1, 1, 0.5);
  Matrix halves(2 * n, n);
  halves << unit, -unit;
  return {
      {"ball1", convex::ball1(1.5), convex::norm_inf(1.5), cross},
      {"simplex", convex::simplex(1), convex::max(), unit},
      {"capped_simplex", convex::capped_simplex(2), convex::sum_largest(2),
       columns_with_sum(grid(n, {0, 1}), 2)},
      {"ball_inf", convex::ball_inf(0.5), convex::norm1(0.5), grid(n, {-0.5, 0.5})},
      {"box", convex::box(-1, 2), convex::support(convex::box(-1, 2)), grid(n, {-1, 2})},
      {"bounded_partial_sums", convex::bounded_partial_sums(0.75), convex::total_variation(0.75),
       differences * grid(n - 1, {-1, 1})},
      {"signed_permutahedron", convex::signed_permutahedron(weights), convex::sorted_norm1(weights),
       signed_permutations(weights)},
      {"polyhedron", convex::polyhedron(halves, Vector::Ones(2 * n)),
       convex::support(convex::polyhedron(halves, Vector::Ones(2 * n))), grid(n, {-1, 1})},
      {"max_affine", convex::simplex(1), convex::max_affine(unit, Vector::Zero(n)), unit},
  };
}

std::vector<Vector> points() {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  std::vector<Vector> points = {Vector::Zero(4), Vector::Ones(4)};
  for (double scale : {0.1, 1.0, 5.0, 1e6})
    for (int repeat = 0; repeat < 15; ++repeat) {
      Vector z(4);
      for (double& entry : z) entry = scale * normal(generator);
      if (repeat % 3 == 0)
        for (double& entry : z) entry = scale * std::round(entry / scale);  // ties
      points.push_back(z);
    }
  return points;
}

}  // namespace

TEST_CASE("the support function of a polytope is the largest product with a vertex") {
  for (const Polytope& P : polytopes())
    for (const Vector& v : points()) {
      CAPTURE(P.name);
      CAPTURE(v.transpose());
      const double largest = (P.vertices.transpose() * v).maxCoeff();
      CHECK(std::abs(P.support(v) - largest) <= 1e-15 * v.norm() * P.vertices.norm());
      const auto maximiser = P.support.subgradient(v);
      REQUIRE(maximiser);
      CHECK(P.set.indicator(*maximiser) == 0);
      CHECK(std::abs(maximiser->dot(v) - largest) <= 1e-13 * v.norm() * P.vertices.norm());
    }
}

TEST_CASE("no vertex lies on the other side of a projection, and the projection is among them") {
  for (const Polytope& P : polytopes())
    for (const Vector& z : points()) {
      CAPTURE(P.name);
      CAPTURE(z.transpose());
      const Vector x = P.set.indicator.prox(z, Metric::identity(4)).x;
      const double size = z.norm() + P.vertices.norm();
      CHECK((P.vertices.transpose() * (z - x)).maxCoeff() - x.dot(z - x) <= 1e-14 * size * size);
      CHECK(P.set.indicator(x) == 0);
      for (const Vector& direction : points())
        CHECK(x.dot(direction) <=
              (P.vertices.transpose() * direction).maxCoeff() + 1e-14 * direction.norm() * size);
    }
}

TEST_CASE("in a diagonal metric a projection has the metric's right angle") {
  const Vector d = Eigen::Vector4d(0.5, 3, 1, 20);
  for (const Polytope& P : polytopes())
    for (const Vector& z : points()) {
      CAPTURE(P.name);
      CAPTURE(z.transpose());
      const Vector x = P.set.indicator.prox(z, Metric::diagonal(d)).x;
      const Vector force = d.cwiseProduct(z - x);
      const double size = d.maxCoeff() * (z.norm() + P.vertices.norm());
      CHECK((P.vertices.transpose() * force).maxCoeff() - x.dot(force) <= 1e-13 * size * size);
      CHECK(P.set.indicator(x) == 0);
    }
}

TEST_CASE("a vertex is in its polytope, and a point beyond it is not") {
  for (const Polytope& P : polytopes()) {
    CAPTURE(P.name);
    const Vector centre = P.vertices.rowwise().mean();
    for (Index k = 0; k < P.vertices.cols(); ++k) {
      const Vector vertex = P.vertices.col(k);
      CHECK(P.set.indicator(vertex) == 0);
      CHECK(std::isinf(P.set.indicator(vertex + 1e-6 * (vertex - centre))));
    }
  }
}
