#include "convex/cones/exact_metric.hpp"

#include <cmath>

#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"

namespace convex::inline cones {
namespace {

/// As in Metric::dense: entries that should be equal may differ by so many roundings per coordinate.
constexpr double symmetry_roundings = 16;

ExactMetric metric_of(IntegerRows gram, Integer denominator) {
  auto inverse = positive_definite_inverse(gram);
  if (!inverse)
    throw InvalidInput("metric: not positive definite; give a symmetric positive definite matrix");
  return {std::move(gram), std::move(denominator), std::move(*inverse)};
}

}  // namespace

void require_symmetric(const ExactRows& W) {
  const std::size_t n = W.size();
  Matrix rounded(static_cast<Index>(n), static_cast<Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    if (W[i].numerators.size() != n)
      throw InvalidInput("metric: " + counted(n, "row", "rows") + ", but row " + std::to_string(i) + " has " +
                         counted(W[i].numerators.size(), "entry", "entries") + "; give a square matrix");
    rounded.row(static_cast<Index>(i)) = nearest(W[i]);
  }
  const double slack = symmetry_roundings * unit_roundoff * static_cast<double>(n);
  // Equal ones may round to what has no difference.
  const auto are_equal = [&](Index i, Index j) {
    const auto p = static_cast<std::size_t>(i), q = static_cast<std::size_t>(j);
    return W[p].numerators[q] * W[q].denominator == W[q].numerators[p] * W[p].denominator;
  };
  for (Index i = 0; i < rounded.rows(); ++i)
    for (Index j = 0; j < i; ++j)
      if (!(std::abs(rounded(i, j) - rounded(j, i)) <=
            slack * std::sqrt(std::abs(rounded(i, i))) * std::sqrt(std::abs(rounded(j, j)))) &&
          !are_equal(i, j))
        throw InvalidInput("metric: not symmetric: its entries [" + std::to_string(i) + "][" +
                           std::to_string(j) + "] and [" + std::to_string(j) + "][" + std::to_string(i) +
                           "] differ; give a symmetric matrix");
}

ExactMetric identity_metric(Index n) {
  const auto size = static_cast<std::size_t>(n);
  IntegerRows gram(size, IntegerVector(size, 0));
  for (std::size_t i = 0; i < size; ++i) gram[i][i] = 1;
  return metric_of(std::move(gram), 1);
}

ExactMetric exact_metric(const ExactRows& W) {
  require_symmetric(W);
  IntegerMatrix M = over_one_denominator(W);
  const std::size_t n = W.size();
  IntegerRows twice = M.rows;
  bool symmetric = true;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      symmetric = symmetric && M.rows[i][j] == M.rows[j][i];
      twice[i][j] = M.rows[i][j] + M.rows[j][i];
    }
  return symmetric ? metric_of(std::move(M.rows), M.denominator)
                   : metric_of(std::move(twice), M.denominator * 2);
}

ExactMetric exact_metric(const Metric& W) {
  Matrix gram = Matrix::Zero(W.dimension(), W.dimension());
  if (W.kind() == MetricKind::dense)
    gram = W.dense_gram();
  else if (W.kind() == MetricKind::sparse)
    gram = Matrix(W.sparse_gram());
  else
    gram.diagonal() = W.diagonal();
  return exact_metric(exact_rows(gram));
}

Fraction inner(const ExactMetric& W, const ExactVector& x, const ExactVector& y) {
  return {dot(times(x.numerators, W.gram), y.numerators), x.denominator * y.denominator * W.denominator};
}

}  // namespace convex::inline cones
