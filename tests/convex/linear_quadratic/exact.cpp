#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <random>

#include "convex/linear_quadratic/functions.hpp"
#include "convex/linear_quadratic/minimise.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/prox.hpp"
#include "convex/linear_quadratic/sets.hpp"
#include "tests/convex/linear_quadratic/samples.hpp"
#include "tests/oracles/rational_kkt.hpp"

using convex::Index;
using convex::LinearQuadratic;
using convex::Matrix;
using convex::Metric;
using convex::Prox;
using convex::Vector;
using oracles::Rational;
using oracles::RationalVector;
namespace lq = convex::linear_quadratic;

namespace {

/// Solves M u = r in fractions, unknowns without a pivot left at 0; none when it has no solution.
std::optional<RationalVector> solve(std::vector<RationalVector> M) {
  const std::size_t columns = M.empty() ? 0 : M[0].size() - 1;
  const std::vector<std::size_t> pivots = oracles::row_reduce(M, columns);
  for (std::size_t i = pivots.size(); i < M.size(); ++i)
    if (M[i][columns] != 0) return std::nullopt;
  RationalVector u(columns);
  for (std::size_t i = 0; i < pivots.size(); ++i) u[pivots[i]] = M[i][columns];
  return u;
}

/// The prox in fractions: every set of rows is tried as the active one until the conditions of Karush, Kuhn
/// and Tucker hold exactly.
std::optional<RationalVector> exact_prox(const LinearQuadratic& f, const Matrix& W, const Vector& z) {
  const auto N = static_cast<std::size_t>(f.variables()), m = static_cast<std::size_t>(f.rows());
  const Matrix H = Matrix(f.H), G = Matrix(f.G);
  std::vector<bool> equal(m, false);
  for (Index a : f.two_sided) equal[static_cast<std::size_t>(a)] = true;
  for (unsigned long set = 0; set < (1UL << m); ++set) {
    std::vector<std::size_t> active;
    bool has_all = true;
    for (std::size_t a = 0; a < m; ++a) {
      if ((set >> a) & 1UL)
        active.push_back(a);
      else if (equal[a])
        has_all = false;
    }
    if (!has_all || active.size() > N) continue;
    std::vector<RationalVector> M(N + active.size(), RationalVector(N + active.size() + 1));
    for (std::size_t i = 0; i < N; ++i) {
      const auto row = static_cast<Index>(i);
      M[i].back() = -Rational(f.c[row]);
      for (std::size_t j = 0; j < N; ++j) {
        const auto column = static_cast<Index>(j);
        M[i][j] = Rational(H(row, column));
        if (row < f.n && column < f.n) {
          M[i][j] += Rational(W(row, column));
          M[i].back() += Rational(W(row, column)) * Rational(z[column]);
        }
      }
      for (std::size_t k = 0; k < active.size(); ++k)
        M[i][N + k] = -Rational(G(static_cast<Index>(active[k]), row));
    }
    for (std::size_t k = 0; k < active.size(); ++k) {
      const auto a = static_cast<Index>(active[k]);
      for (std::size_t j = 0; j < N; ++j) M[N + k][j] = Rational(G(a, static_cast<Index>(j)));
      M[N + k].back() = Rational(f.h[a]);
    }
    const std::optional<RationalVector> found = solve(std::move(M));
    if (!found) continue;
    bool holds = true;
    for (std::size_t k = 0; k < active.size() && holds; ++k) holds = equal[active[k]] || (*found)[N + k] >= 0;
    for (std::size_t a = 0; a < m && holds; ++a) {
      Rational slack = -Rational(f.h[static_cast<Index>(a)]);
      for (std::size_t j = 0; j < N; ++j)
        slack += Rational(G(static_cast<Index>(a), static_cast<Index>(j))) * (*found)[j];
      holds = slack >= 0;
    }
    if (holds) return RationalVector(found->begin(), found->begin() + f.n);
  }
  return std::nullopt;
}

double distance(const Vector& x, const RationalVector& exact, const Matrix& W) {
  Vector difference(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const Rational d = Rational(x[i]) - exact[static_cast<std::size_t>(i)];
    difference[i] = d.get_d();
  }
  return std::sqrt(difference.dot(W * difference));
}

}  // namespace

TEST_CASE("the prox is that of fractions, found by trying all active sets, ties and kinks included") {
  std::mt19937 generator(11);
  Matrix turn(2, 2);
  turn << 1, 1, 1, -1;
  int found_in_fractions = 0;
  for (double stiffness : {1.0, 8.0, 0x1p20})
    for (const auto& [name, f] : samples::catalogue(2)) {
      if (f.rows() > 9) continue;
      const Matrix W = turn * Eigen::Vector2d(1, stiffness).asDiagonal() * turn;  // exact
      for (double scale : {1.0, 0x1p20, 0x1p-10}) {
        CAPTURE(name);
        CAPTURE(stiffness);
        CAPTURE(scale);
        const Vector z = samples::tied_point(generator, 2, scale);
        const std::optional<RationalVector> exact = exact_prox(f, W, z);
        if (!exact) continue;
        ++found_in_fractions;
        const Prox found = prox(f, z, Metric::dense(W));
        REQUIRE(found.status == convex::Status::solved);
        const double size = std::sqrt(z.dot(W * z)) + std::sqrt(found.x.dot(W * found.x));
        const double error = distance(found.x, *exact, W);
        const double rounding = 4e-16 * std::sqrt(stiffness);
        CHECK(error <= rounding * (size + std::sqrt(stiffness) * 1e-3));
        CHECK(error <= 1.01 * found.error_bound + 1e-17 * size);
      }
    }
  CHECK(found_in_fractions > 150);
}

TEST_CASE(
    "the prox of weight/2 |Ax + b|^2 is within its bound of that of fractions, whatever AᵀA rounds to") {
  std::mt19937 generator(17);
  std::normal_distribution<double> normal;
  const Index n = 3;
  const Matrix I = Matrix::Identity(n, n);
  for (const Index m : {2, 3, 5})
    for (const double weight : {1.3, 900.0, 1e5})
      for (const double offset : {1.0, 50.0}) {
        CAPTURE(m);
        CAPTURE(weight);
        CAPTURE(offset);
        const auto draw = [&] { return normal(generator); };
        const Matrix A = Matrix::NullaryExpr(m, n, draw);
        const Vector b = offset * Vector::NullaryExpr(m, draw), z = Vector::NullaryExpr(n, draw);
        std::vector<RationalVector> M(n, RationalVector(n + 1));  // (1 + weight AᵀA) x = z - weight Aᵀb
        for (Index i = 0; i < n; ++i) {
          RationalVector& row = M[static_cast<std::size_t>(i)];
          row[static_cast<std::size_t>(i)] = 1;
          row.back() = Rational(z[i]);
          for (Index k = 0; k < m; ++k) {
            const Rational weighted = Rational(weight) * Rational(A(k, i));
            row.back() -= weighted * Rational(b[k]);
            for (Index j = 0; j < n; ++j) row[static_cast<std::size_t>(j)] += weighted * Rational(A(k, j));
          }
        }
        const std::optional<RationalVector> exact = solve(std::move(M));
        REQUIRE(exact);
        const Prox found =
            prox(lq::precompose(lq::squared_norm2(m, weight), A.sparseView(), b), z, Metric::identity(n));
        REQUIRE(found.status == convex::Status::solved);
        CHECK(distance(found.x, *exact, I) <= 1.01 * found.error_bound + 1e-17 * found.x.norm());
      }
}

TEST_CASE("in the identity metric the prox has its known closed forms") {
  std::mt19937 generator(12);
  const Index n = 7;
  const Metric I = Metric::identity(n);
  for (int repeat = 0; repeat < 30; ++repeat) {
    const Vector z = samples::tied_point(generator, n, 1);
    const double tiny = 1e-14 * (1 + z.norm());
    // Soft threshold (Donoho 1995).
    const Vector soft =
        z.unaryExpr([](double t) { return std::copysign(std::max(0.0, std::abs(t) - 1), t); });
    CHECK((prox(lq::norm1(n, 1), z, I).x - soft).norm() <= tiny);
    const Vector huber = z.unaryExpr([](double t) { return t - t / std::max(1.5, std::abs(t)); });
    CHECK((prox(lq::huber(n, 0.5), z, I).x - huber).norm() <= tiny);
    CHECK((prox(lq::ball_inf(n, 1), z, I).x - z.cwiseMax(-1).cwiseMin(1)).norm() <= tiny);
    const Vector hinge = z.unaryExpr([](double t) { return t < 0 ? t + 1 : std::max(t, 1.0); });
    CHECK((prox(lq::hinge(n), z, I).x - hinge).norm() <= tiny);
    // The level of a simplex projection by bisection.
    double low = z.minCoeff() - 1, high = z.maxCoeff();
    for (int k = 0; k < 200; ++k) {
      const double level = 0.5 * (low + high);
      ((z.array() - level).max(0).sum() > 1 ? low : high) = level;
    }
    const Vector simplex = (z.array() - low).max(0);
    CHECK((prox(lq::simplex(n, 1), z, I).x - simplex).norm() <= tiny);
    CHECK((prox(lq::max(n), z, I).x - (z - simplex)).norm() <= tiny);  // conjugate of the simplex
  }
}

TEST_CASE(
    "far corners of an orthant in an ill-conditioned metric are reached without going round in circles") {
  std::mt19937 generator(13);
  for (int repeat = 0; repeat < 1500; ++repeat) {
    CAPTURE(repeat);
    const Metric W = samples::random_metric(generator, 5, 1e6);
    const Vector z = samples::tied_point(generator, 5, 1);
    CHECK(prox(lq::orthant(5), z, W).status == convex::Status::solved);
  }
}
