#include "convex/functions/semidefinite.hpp"

#include <cstdio>
#include <optional>
#include <string>

#include "convex/exact/elimination.hpp"
#include "convex/exact/fraction.hpp"
#include "convex/exact/positive_definite.hpp"
#include "convex/invalid_input.hpp"
#include "convex/linear_algebra/householder.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"

namespace convex::inline named_functions {
namespace {

/// Some ten milliseconds for entries of one size.
constexpr Index most_decided = 64;

/// Of which nothing is rounded.
Spectrum spectrum_of_diagonal(const Vector& values) {
  const Index n = values.size(), rank = (values.array() > 0).count();
  Spectrum found{Matrix::Zero(n, rank), Matrix::Zero(n, n - rank), Vector(rank)};
  Index range = 0, null = 0;
  for (Index i = 0; i < n; ++i) {
    if (values[i] > 0) {
      found.basis(i, range) = 1;
      found.values[range++] = values[i];
    } else {
      found.null(i, null++) = 1;
    }
  }
  return found;
}

/// The null space, n×(n - r) orthonormal, of a Q that is semidefinite as it stands; else none. A symmetric
/// matrix of rank r has the signs of its r×r block at independent rows.
std::optional<Matrix> null_space(const Matrix& Q) {
  const auto n = static_cast<std::size_t>(Q.rows());
  const IntegerRows rows = over_one_denominator(exact_rows(Q)).rows;
  const Echelon range = echelon(rows, n);
  IntegerRows block;
  for (const std::size_t i : range.pivots) {
    IntegerVector& row = block.emplace_back();
    for (const std::size_t j : range.pivots) row.push_back(rows[i][j]);
  }
  if (!is_positive_definite(block)) return std::nullopt;
  const IntegerRows null = annihilator(range).rows;
  Matrix spanning(Q.rows(), static_cast<Index>(null.size()));
  for (std::size_t k = 0; k < null.size(); ++k) {
    Integer largest = 1;
    for (const Integer& entry : null[k]) largest = std::max(largest, entry.sign() < 0 ? -entry : entry);
    for (std::size_t i = 0; i < n; ++i)
      spanning(static_cast<Index>(i), static_cast<Index>(k)) = nearest_double(Fraction{null[k][i], largest});
  }
  if (spanning.cols() == 0) return spanning;
  return linear_algebra::Householder(spanning).Q(spanning.cols());
}

}  // namespace

Spectrum spectrum_of(const Matrix& Q) {
  if (Q.isDiagonal(0) && (Q.diagonal().array() >= 0).all()) return spectrum_of_diagonal(Q.diagonal());
  const linear_algebra::SymmetricEigen eigen(Q);
  const Vector& values = eigen.values;
  const Index n = Q.rows();
  const double negligible = rank_tolerance * static_cast<double>(n) * values.cwiseAbs().maxCoeff();
  if (values.minCoeff() < -negligible) {
    char least[32];
    std::snprintf(least, sizeof least, "%.4g", values.minCoeff());
    throw InvalidInput("quadratic(Q): not positive semidefinite, an eigenvalue is " + std::string(least) +
                       "; the function would not be convex");
  }
  const Index rank = (values.array() > negligible).count();
  Spectrum found{eigen.vectors.rightCols(rank), eigen.vectors.leftCols(n - rank), values.tail(rank),
                 values.minCoeff() > 2 * negligible};
  if (found.is_sure || n > most_decided) return found;
  if (auto null = null_space(Q); null && null->cols() == n - rank) {
    found.null = *std::move(null);
    found.is_sure = true;
  }
  return found;
}

}  // namespace convex::inline named_functions
