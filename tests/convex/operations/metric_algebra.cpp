#include "convex/operations/metric_algebra.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>

#include "tests/convex/operations/samples.hpp"

using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::MetricKind;
using convex::Vector;
using samples::LongMatrix;

namespace {

/// Sums and inverses of metrics lose at most so much, for the condition numbers of these samples.
constexpr double few_roundings = 1e-13;

double difference(const Metric& found, const LongMatrix& expected) {
  const LongMatrix gap = convex::gram(found).cast<long double>() - expected;
  return static_cast<double>(gap.cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff());
}

LongMatrix exact(const Metric& W) { return convex::gram(W).cast<long double>(); }

}  // namespace

TEST_CASE("sums, inverses, parallel sums and congruences are those of the matrices in higher precision") {
  for (Index n : {1, 2, 5})
    for (const Metric& W : samples::metrics(n))
      for (const Metric& V : samples::metrics(n)) {
        CHECK(difference(convex::plus(W, V), exact(W) + exact(V)) <= few_roundings);
        CHECK(difference(convex::inverse(W), exact(W).inverse()) <= few_roundings);
        const LongMatrix parallel = (exact(W).inverse() + exact(V).inverse()).inverse();
        CHECK(difference(convex::parallel_sum(W, V), parallel) <= few_roundings);
        CHECK(difference(convex::congruence(V, W), exact(V) * exact(W).inverse() * exact(V)) <=
              few_roundings);
      }
}

TEST_CASE("diagonal metrics stay diagonal, and a metric in its own product stays itself") {
  const Metric D = Metric::diagonal(Vector::LinSpaced(4, 1, 7)), I = Metric::identity(4);
  for (const Metric& W :
       {convex::plus(D, I), convex::inverse(D), convex::parallel_sum(D, I), convex::congruence(I, D)})
    CHECK(W.kind() == MetricKind::diagonal);
  const Metric dense = samples::dense(4, 3);
  CHECK(convex::gram(convex::congruence(dense, dense)) == convex::gram(dense));
  CHECK(convex::parallel_sum(dense, dense.scaled(3)).dense_gram().isApprox(0.75 * dense.dense_gram(), 1e-15));
}

TEST_CASE("a metric couples blocks exactly when an entry stands outside them") {
  Matrix W = Matrix::Identity(4, 4);
  W(0, 1) = W(1, 0) = 0.5;
  for (const Metric& metric : {Metric::dense(W), Metric::sparse(W.sparseView())}) {
    CHECK_FALSE(convex::couples(metric, {2, 2}));
    CHECK(convex::couples(metric, {1, 3}));
    CHECK(convex::gram(convex::block(metric, 0, 2)) == W.topLeftCorner(2, 2));
  }
}

TEST_CASE("the metric of an image is the least norm over the points with that image") {
  for (const Metric& W : samples::metrics(4))
    for (unsigned seed = 0; seed < 5; ++seed) {
      const Matrix A = samples::matrix(2, 4, seed);
      const auto image = convex::image_metric(W, A);
      REQUIRE(image);
      const LongMatrix long_A = A.cast<long double>();
      const LongMatrix expected = (long_A * exact(W).inverse() * long_A.transpose()).inverse();
      CHECK(difference(image->metric, expected) <= few_roundings);
    }
}

TEST_CASE("rows that depend on each other leave no metric, and orthogonal rows a diagonal one") {
  Matrix A(2, 3);
  A << 1, 2, 3, 2, 4, 6;
  CHECK_FALSE(convex::image_metric(Metric::identity(3), A));
  CHECK_FALSE(convex::image_metric(Metric::identity(3), Matrix::Ones(4, 3)));
  A << 1, 1, 0, 1, -1, 5;
  CHECK(convex::image_metric(Metric::identity(3), A)->metric.kind() == MetricKind::diagonal);
  A << 1, 1, 0, 1, -1, 5e-9;
  CHECK(convex::image_metric(Metric::identity(3), A)->metric.kind() == MetricKind::diagonal);
  A << 1, 1, 0, 1, -1 + 1e-9, 0;
  CHECK(convex::image_metric(Metric::identity(3), A)->metric.kind() == MetricKind::dense);
  // Orthogonality is that of the metric.
  const Metric W = samples::dense(3, 1);
  A << 1, 1, 0, 1, -1, 5;
  CHECK(convex::image_metric(W, A)->metric.kind() == MetricKind::dense);
}
