#include "convex/nearest_point/pivoting/gram_factor.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/nearest_point/gallery/gallery.hpp"

namespace {

using convex::Arena;
using convex::GramFactor;
using convex::GramRows;
using convex::Index;
using convex::Matrix;
using convex::Vector;

/// The rows looked at, all of them, and a factor of none.
struct Looked {
  convex::NearestPointProblem problem;
  Arena arena;
  Vector w_free;
  std::optional<GramRows> rows;
  std::optional<GramFactor> factor;

  Looked(Index n, Index m, unsigned seed) : problem(drawn(n, m, seed)), w_free(Vector::Zero(n + 8)) {
    arena.start(GramRows::lines(n, m, m) + GramFactor::lines(n) + 64);
    rows.emplace(problem, arena, m, w_free.data());
    std::vector<Index> all(static_cast<std::size_t>(m));
    for (std::size_t a = 0; a < all.size(); ++a) all[a] = static_cast<Index>(a);
    REQUIRE(rows->add(all.data(), m));
    factor.emplace(*rows, arena, n);
  }

  static convex::NearestPointProblem drawn(Index n, Index m, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    Matrix B(n, n);
    convex::RowMatrix U(m, n);
    for (double& x : B.reshaped()) x = normal(generator);
    for (double& x : U.reshaped()) x = normal(generator);
    const Matrix A = B * B.transpose() + Matrix::Identity(n, n);
    return {convex::Metric::dense(A), Vector::Zero(n), convex::ConstraintRows(U), Vector::Zero(m), {}};
  }

  /// How far (VᵀV) x is from b, in parts of its terms, for the x that the factor gives.
  double defect(std::mt19937& generator) const {
    const Index k = factor->size();
    std::normal_distribution<double> normal;
    Vector b = Vector::Zero(convex::padded(k));
    for (Index j = 0; j < k; ++j) b[j] = normal(generator);
    Eigen::Matrix<double, Eigen::Dynamic, 1> x = b;
    Arena aligned;
    aligned.start(convex::padded(k) / 8 + 1);
    double* const at = aligned.take_filled(k, 0.0);
    for (Index j = 0; j < k; ++j) at[j] = b[j];
    factor->solve(at);
    double worst = 0;
    for (Index i = 0; i < k; ++i) {
      double sum = -b[i], terms = std::abs(b[i]);
      for (Index j = 0; j < k; ++j) {
        const double term = rows->gram(factor->place(i))[factor->place(j)] * at[j];
        sum += term;
        terms += std::abs(term);
      }
      worst = std::max(worst, std::abs(sum) / terms);
    }
    return worst;
  }
};

}  // namespace

TEST_CASE("whatever rows come and go, the factor solves with the Gram matrix of those that stay") {
  std::mt19937 generator(1966);
  for (const Index n : {1, 3, 8, 9, 17, 40}) {
    Looked looked(n, 2 * n + 5, static_cast<unsigned>(n));
    GramFactor& factor = *looked.factor;
    std::vector<Index> outside;
    for (Index p = 0; p < 2 * n + 5; ++p) outside.push_back(p);
    Arena room;
    room.start(convex::padded(n) / 8 + 1);
    double* const column = room.take<double>(n);
    for (int change = 0; change < 200; ++change) {
      const bool grows = factor.size() == 0 || (factor.size() < n && generator() % 3 != 0);
      if (grows) {
        const std::size_t chosen = generator() % outside.size();
        const double distance = factor.distance(outside[chosen], column);
        REQUIRE(distance > 0);
        factor.append(outside[chosen], column, distance);
        outside.erase(outside.begin() + static_cast<std::ptrdiff_t>(chosen));
      } else {
        const Index j = static_cast<Index>(generator() % static_cast<unsigned>(factor.size()));
        outside.push_back(factor.place(j));
        factor.remove(j);
      }
      if (factor.size() > 0) CHECK(looked.defect(generator) <= 1e-11);
    }
    factor.keep_first(factor.size() / 2);
    if (factor.size() > 0) CHECK(looked.defect(generator) <= 1e-11);
  }
}

TEST_CASE("a factor made at once and one made row by row agree") {
  std::mt19937 generator(3);
  Looked at_once(20, 30, 5), by_rows(20, 30, 5);
  Arena room;
  room.start(4);
  double* const column = room.take<double>(20);
  at_once.factor->clear();
  for (Index p = 0; p < 13; ++p) {
    at_once.factor->list(p);
    by_rows.factor->append(p, column, by_rows.factor->distance(p, column));
  }
  REQUIRE(at_once.factor->factor(1e-11));
  for (Index j = 0; j < 13; ++j)
    CHECK(std::abs(at_once.factor->pivot(j) - by_rows.factor->pivot(j)) <= 1e-13 * at_once.factor->pivot(j));
}

TEST_CASE("of rows that depend on those before, each is told of once and left out") {
  Looked looked(4, 12, 9);  // any four rows span all
  looked.factor->clear();
  for (Index p = 0; p < 4; ++p) looked.factor->list(p);
  CHECK(looked.factor->factor(1e-11));
  looked.factor->clear();
  looked.factor->list(0);
  looked.factor->list(1);
  looked.factor->list(1);
  CHECK_FALSE(looked.factor->factor(1e-11));
  std::vector<Index> left;
  CHECK(looked.factor->leave_dependent(1e-11, [&](Index j) {
    left.push_back(j);
    return true;
  }));
  CHECK(left == std::vector<Index>{2});
  CHECK(looked.factor->size() == 2);
  CHECK(looked.factor->factor(1e-11));
}
