#include "convex/metric.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/invalid_input.hpp"

using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::Vector;

namespace {

/// The same metric stored in every way that can hold it.
std::vector<Metric> metrics(Index n, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  Matrix B = Matrix::Zero(n, n);
  Vector d(n);
  for (Index i = 0; i < n; ++i) {
    for (Index j = std::max<Index>(0, i - 2); j <= i; ++j) B(i, j) = normal(generator);
    d[i] = std::abs(normal(generator)) + 0.1;
  }
  const Matrix W = B * B.transpose() + Matrix::Identity(n, n);
  return {Metric::identity(n), Metric::diagonal(d), Metric::dense(W), Metric::sparse(W.sparseView())};
}

}  // namespace

TEST_CASE("whitening turns the metric and its dual into the plain one") {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  for (Index n : {1, 2, 7, 30})
    for (const Metric& W : metrics(n, generator)) {
      Vector x(n), c(n);
      for (Index i = 0; i < n; ++i) {
        x[i] = normal(generator);
        c[i] = normal(generator);
      }
      const double tiny = 1e-12 * static_cast<double>(n);
      CHECK((W.multiply(W.solve(c)) - c).norm() <= tiny * c.norm() * W.factor_condition());
      CHECK(std::abs(W.norm(x) * W.norm(x) - W.inner(x, x)) <= tiny * W.inner(x, x));
      CHECK(std::abs(W.whiten(c).squaredNorm() - c.dot(W.solve(c))) <=
            tiny * c.dot(W.solve(c)) * W.factor_condition());
      CHECK(std::abs(W.norm(W.unwhiten(c)) - c.norm()) <= tiny * c.norm() * W.factor_condition());
      CHECK(std::abs(W.unwhiten(W.whiten(c)).dot(c) - W.solve(c).dot(c)) <=
            tiny * W.solve(c).norm() * c.norm());
    }
}

TEST_CASE("a matrix that is no metric is refused, with the reason") {
  Matrix asymmetric(2, 2), indefinite(2, 2), semidefinite(2, 2);
  asymmetric << 2, 1, 0, 2;
  indefinite << 1, 2, 2, 1;
  semidefinite << 1, 1, 1, 1;
  CHECK_THROWS_WITH_AS(Metric::dense(asymmetric), doctest::Contains("not symmetric: A[0][1]"),
                       convex::InvalidInput);
  CHECK_THROWS_WITH_AS(Metric::dense(indefinite), doctest::Contains("not positive definite"),
                       convex::InvalidInput);
  CHECK_THROWS_WITH_AS(Metric::dense(semidefinite), doctest::Contains("not positive definite"),
                       convex::InvalidInput);
  CHECK_THROWS_AS(Metric::dense(Matrix::Zero(2, 3)), convex::InvalidInput);
  CHECK_THROWS_AS(Metric::sparse(asymmetric.sparseView()), convex::InvalidInput);
  CHECK_THROWS_AS(Metric::sparse(indefinite.sparseView()), convex::InvalidInput);
  CHECK_THROWS_AS(Metric::diagonal(Vector::Zero(2)), convex::InvalidInput);
  indefinite(0, 1) = indefinite(1, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(Metric::dense(indefinite), doctest::Contains("not finite"), convex::InvalidInput);
}

TEST_CASE("the rounding of a computed matrix is no asymmetry") {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  Matrix B(60, 60);
  for (Index i = 0; i < B.size(); ++i) B.data()[i] = normal(generator);
  CHECK_NOTHROW(Metric::dense(B * B.transpose()));
}

TEST_CASE("a singular matrix is refused whose last pivot is the rounding of others, dense and sparse") {
  // W (7, 7, 1) = 0, and the pivots are 49, 1 and what 1/7 left of 0.
  const Matrix W{{49, -49, 0}, {-49, 50, -7}, {0, -7, 49}};
  CHECK_THROWS_AS(Metric::dense(W), convex::InvalidInput);
  CHECK_THROWS_AS(Metric::sparse(W.sparseView()), convex::InvalidInput);
  // A chain of whole numbers: W = Σ (p_j e_i - p_i e_j)(…)ᵀ over neighbours i, j, with W p = 0.
  std::mt19937 random(1966);
  for (const Index n : {4, 12, 40, 90})
    for (int draw = 0; draw < 20; ++draw) {
      CAPTURE(n);
      Vector p(n);
      for (double& entry : p) entry = static_cast<double>(1 + random() % 9);
      Matrix chain = Matrix::Zero(n, n);
      for (Index i = 1; i < n; ++i) {
        Vector link = Vector::Zero(n);
        link[i] = p[i - 1];
        link[i - 1] = -p[i];
        chain += link * link.transpose();
      }
      CHECK_THROWS_AS(Metric::dense(chain), convex::InvalidInput);
      CHECK_THROWS_AS(Metric::sparse(chain.sparseView()), convex::InvalidInput);
      chain(0, 0) += 1;  // and is definite
      CHECK(Metric::dense(chain).dimension() == n);
    }
}
