#include "convex/laws/trial.hpp"

#include <cmath>
#include <random>

#include "convex/invalid_input.hpp"
#include "convex/linear_algebra/householder.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"

namespace convex::inline law_checks {
namespace {

void require_entries(Index n) {
  if (n < 1) throw InvalidInput("n: not positive; give the number of entries to try the laws on");
}

Vector normal_vector(std::mt19937& generator, Index n) {
  std::normal_distribution<double> normal;
  Vector x(n);
  for (Index i = 0; i < n; ++i) x[i] = normal(generator);
  return x;
}

}  // namespace

Matrix matrix_of_condition(Index n, double condition) {
  std::mt19937 generator(1966);
  Matrix B(n, n);
  for (Index j = 0; j < n; ++j) B.col(j) = normal_vector(generator, n);
  const Matrix Q = linear_algebra::Householder(B).Q(n);
  Vector d(n);
  for (Index i = 0; i < n; ++i)
    d[i] = n > 1 ? std::pow(condition, static_cast<double>(i) / static_cast<double>(n - 1) - 0.5) : 2;
  const Matrix W = Q * d.asDiagonal() * Q.transpose();
  return (W + W.transpose()) / 2;
}

std::vector<NamedMetric> trial_metrics(Index n) {
  require_entries(n);
  Vector d(n);
  for (Index i = 0; i < n; ++i) d[i] = std::ldexp(3.0, static_cast<int>(i % 4) - 2);
  return {{"identity", Metric::identity(n)},
          {"diagonal", Metric::diagonal(d)},
          {"dense", Metric::dense(matrix_of_condition(n, 10))},
          {"condition 1e6", Metric::dense(matrix_of_condition(n, 1e6))}};
}

std::vector<Vector> trial_points(Index n) {
  require_entries(n);
  std::vector<Vector> points{Vector::Zero(n), Vector::Ones(n), -2 * Vector::Ones(n)};
  Vector whole(n), lone = Vector::Zero(n);
  for (Index i = 0; i < n; ++i) whole[i] = static_cast<double>(i % 2 == 0 ? i + 1 : -i - 1);
  lone[n - 1] = 3;
  points.push_back(whole);
  points.push_back(lone);
  std::mt19937 generator(3);
  for (double size : {0.1, 1.0, 1.0, 1.0, 5.0, 1e4}) points.push_back(size * normal_vector(generator, n));
  return points;
}

Matrix gram_matrix(const Metric& W) {
  switch (W.kind()) {
    case MetricKind::dense:
      return W.dense_gram();
    case MetricKind::sparse:
      return Matrix(W.sparse_gram());
    default:
      return W.diagonal().asDiagonal();
  }
}

Spectrum spectrum(const Metric& W) {
  const Vector values = linear_algebra::eigenvalues(gram_matrix(W));
  return {values.minCoeff(), values.maxCoeff()};
}

double rounding_bound(const Metric& W, const Vector& z, const Vector& x) {
  return 4 * unit_roundoff * static_cast<double>(z.size()) * spectrum(W).condition() *
         (W.norm(z) + W.norm(x));
}

}  // namespace convex::inline law_checks
