#pragma once

#include <random>
#include <string_view>
#include <vector>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/metric.hpp"

/// Functions by their text, metrics and points for the tests of operations.
namespace samples {

using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::Vector;
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

inline convex::Function function(std::string_view text, const Metric& product) {
  return convex::make_function(cli::parse_call(text, "f"), {product});
}
inline convex::Function function(std::string_view text, Index n) {
  return function(text, Metric::identity(n));
}

inline Matrix matrix(Index m, Index n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Matrix A(m, n);
  for (Index i = 0; i < A.size(); ++i) A.data()[i] = normal(generator);
  return A;
}

inline Vector vector(Index n, unsigned seed) { return matrix(n, 1, seed + 1000); }

/// B Bᵀ + I.
inline Metric dense(Index n, unsigned seed) {
  const Matrix B = matrix(n, n, seed + 77);
  return Metric::dense(B * B.transpose() + Matrix::Identity(n, n));
}

inline std::vector<Metric> metrics(Index n) {
  const Vector d = vector(n, 5).cwiseAbs() + Vector::Constant(n, 0.25);
  const Matrix W = convex::Matrix(dense(n, 9).dense_gram());
  return {Metric::identity(n), Metric::diagonal(d), dense(n, 2), Metric::sparse(W.sparseView())};
}

/// Points near and far, with ties and zeros.
inline std::vector<Vector> points(Index n) {
  std::vector<Vector> all = {Vector::Zero(n), Vector::Ones(n), Vector::Constant(n, -2)};
  for (unsigned seed = 0; seed < 3; ++seed) all.push_back(vector(n, seed));
  all.push_back(20 * vector(n, 7));
  return all;
}

}  // namespace samples
