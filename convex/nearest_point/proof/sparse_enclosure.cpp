#include "convex/nearest_point/proof/sparse_enclosure.hpp"

#include <cmath>

#include "convex/exact/rounding_bounds.hpp"
#include "convex/linear_algebra/sparse_cholesky.hpp"
#include "convex/nearest_point/proof/kept_point.hpp"
#include "convex/nearest_point/reductions/balanced_problem.hpp"

namespace convex::inline proof {
namespace {

SparseMatrix shifted(const SparseMatrix& M, double shift) {
  SparseMatrix result = M;
  result.diagonal().array() -= shift;
  return result;
}

/// The largest row sum of gamma |L||L|ᵀ, and of what the shift rounded.
double factor_error(const linear_algebra::SparseCholesky& factor, const SparseMatrix& M) {
  const SparseMatrix L = factor.L();
  Eigen::VectorXi in_row = Eigen::VectorXi::Zero(L.rows());
  Vector down = Vector::Zero(L.rows()), across = Vector::Zero(L.rows());
  for (Index j = 0; j < L.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(L, j); it; ++it) {
      ++in_row[it.row()];
      down[j] += std::abs(it.value());
    }
  for (Index j = 0; j < L.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(L, j); it; ++it) across[it.row()] += std::abs(it.value()) * down[j];
  const double rounding = gamma(in_row.maxCoeff() + 2) * across.maxCoeff();
  return above(rounding + 2 * unit_roundoff * M.diagonal().cwiseAbs().maxCoeff());
}

/// A guess of the least eigenvalue by inverse iteration.
double guessed_least_eigenvalue(const linear_algebra::SparseCholesky& factor, Index n) {
  constexpr int iterations = 12;
  Vector x(n);
  for (Index i = 0; i < n; ++i) {  // fixed numbers without a pattern
    const double golden = 0.6180339887498949 * static_cast<double>(i + 1);
    x[i] = golden - std::floor(golden) - 0.5;
  }
  double growth = 1;
  for (int k = 0; k < iterations; ++k) {
    x.normalize();
    x = factor.solve(x);
    growth = x.norm();
  }
  return 1 / growth;
}

/// The power of two near 1/sqrt(x): scaling by it rounds nothing.
double scale_of(double x) { return std::ldexp(1.0, -std::ilogb(x) / 2); }

/// A = diag(1/d) A' diag(1/d) and U_S = diag(1/r) U' diag(1/d) with A' and U' of ordinary size.
struct Balanced {
  SparseMatrix A;
  SparseRows U;
  Vector d, r;
};

Balanced balanced(const NearestPointProblem& problem, const std::vector<Index>& held) {
  Balanced found;
  found.A = sparse_gram(problem.A);
  found.d = problem.A.diagonal().unaryExpr(&scale_of);
  found.A = found.d.asDiagonal() * found.A * found.d.asDiagonal();
  const ConstraintRows rows = problem.U.select(held);
  found.U = rows.is_sparse() ? rows.sparse() : SparseRows(rows.dense().sparseView(0, 0));
  found.U = found.U * found.d.asDiagonal();
  found.r.resize(found.U.rows());
  for (Index k = 0; k < found.r.size(); ++k) found.r[k] = scale_of(found.U.row(k).squaredNorm());
  found.U = found.r.asDiagonal() * found.U;
  return found;
}

/// |M|₁ for a symmetric M: at least |M|₂.
double row_sum_above(const SparseMatrix& M) {
  double largest = 0;
  for (Index j = 0; j < M.outerSize(); ++j) {
    double sum = 0;
    for (SparseMatrix::InnerIterator it(M, j); it; ++it) sum += std::abs(it.value());
    largest = std::max(largest, sum);
  }
  return above(largest);
}

/// |Û'|₂ at most, Û' the radii of the scaled rows.
double row_radii_above(const Balanced& scaled, const RadiiOf& radii, const std::vector<Index>& held) {
  if (!radii.any()) return 0;
  const Vector rows = scaled.r.cwiseProduct(radii.rows_times(held, scaled.d));
  const Vector columns = scaled.d.cwiseProduct(radii.rows_transposed_times(held, scaled.r, scaled.d.size()));
  return above(std::sqrt(rows.maxCoeff() * columns.maxCoeff()));
}

/// A number below the eigenvalues of (U' + E)(U' + E)ᵀ, |E|₂ <= uncertainty.
std::optional<double> least_of_rows(const SparseRows& U, double uncertainty) {
  const SparseMatrix columns = U.transpose();
  const SparseMatrix G = U * columns;
  const SparseMatrix size = columns.cwiseAbs();
  const Vector sums = size.transpose() * Vector(size * Vector::Ones(size.cols()));
  Index longest = 0;
  for (Index k = 0; k < U.rows(); ++k) longest = std::max(longest, U.row(k).nonZeros());
  const auto least = least_eigenvalue_below(G, above(gamma(longest) * sums.maxCoeff()));
  if (!least) return std::nullopt;
  const double singular = below(std::sqrt(*least)) - uncertainty;  // of U'
  if (!(singular > 0)) return std::nullopt;
  return below(below(singular) * singular);
}

/// ||r1||_(A⁻¹) at most, alpha below the eigenvalues of the scaled A.
double imbalance_above(const Balanced& scaled, const KktResidual& rest, double alpha) {
  return above(norm_above(scaled.d.cwiseProduct(rest.r1.cwiseAbs() + rest.r1_radius)) / std::sqrt(alpha));
}

bool slacks_are_positive(const NearestPointProblem& problem, const RadiiOf& radii, const Vector& q,
                         const Vector& reach, const std::vector<bool>& is_held) {
  const Vector size = above(1) * (q.cwiseAbs() + reach);
  for (Index a = 0; a < problem.rows(); ++a) {
    if (is_held[static_cast<std::size_t>(a)]) continue;
    CompensatedSum sum;
    double hidden = radii.s(a) + radii.row_times(a, size);
    sum.add(-problem.s[a], 1);
    problem.U.for_each_entry(a, [&](Index i, double u) {
      sum.add(u, q[i]);
      hidden += std::abs(u) * reach[i];
    });
    const Enclosed slack = sum.result();
    if (!(below(slack.value) > above(slack.radius + above(hidden)))) return false;
  }
  return true;
}

}  // namespace

std::optional<double> least_eigenvalue_below(const SparseMatrix& M, double uncertainty) {
  const linear_algebra::SparseCholesky first(M);
  if (!first.is_definite()) return std::nullopt;
  double shift = 0.5 * guessed_least_eigenvalue(first, M.rows());
  constexpr int tries = 4;
  for (int k = 0; k < tries; ++k, shift /= 8) {
    if (!(shift > 0) || !std::isfinite(shift)) return std::nullopt;
    const linear_algebra::SparseCholesky factor(shifted(M, shift));
    if (!factor.is_definite()) continue;
    const double found = below(shift) - above(factor_error(factor, M) + uncertainty);
    if (found > 0) return below(found);
    return std::nullopt;
  }
  return std::nullopt;
}

std::optional<double> sparse_enclosed_error(const NearestPointProblem& problem, const RadiiOf& radii,
                                            const Solution& solution, const std::vector<Index>& held) {
  if (problem.A.kind() == MetricKind::dense) return std::nullopt;
  const Balanced scaled = balanced(problem, held);
  if (!is_ordinary(scaled.A.coeffs()) || !is_ordinary(scaled.U.coeffs())) return std::nullopt;
  // |D Â D|, by its largest row sum.
  const double loose = above(scaled.d.cwiseProduct(radii.A_times(scaled.d)).maxCoeff());
  const auto alpha = least_eigenvalue_below(scaled.A, loose);
  if (!alpha) return std::nullopt;
  std::optional<double> sigma = 1.0;
  if (!held.empty()) sigma = least_of_rows(scaled.U, row_radii_above(scaled, radii, held));
  if (!sigma) return std::nullopt;
  const double beta = above(row_sum_above(scaled.A) + loose);

  const KktResidual rest = residual_as_it_stands(problem, radii, solution, held);
  const double imbalance = imbalance_above(scaled, rest, *alpha);
  const double gap =
                   held.empty() ? 0 : norm_above(scaled.r.cwiseProduct(rest.r2.cwiseAbs() + rest.r2_radius)),
               weak = above(beta / *sigma);
  const double radius = above(imbalance + std::sqrt(weak) * gap);
  const double change = above(weak * gap + std::sqrt(weak) * imbalance);
  if (!std::isfinite(radius) || !std::isfinite(change)) return std::nullopt;

  const std::vector<bool> is_held = marked(problem.rows(), held),
                          two_sided = marked(problem.rows(), problem.two_sided);
  for (Index a : problem.two_sided)
    if (!is_held[static_cast<std::size_t>(a)]) return std::nullopt;
  for (std::size_t k = 0; k < held.size(); ++k)
    if (!two_sided[static_cast<std::size_t>(held[k])] &&
        !(solution.lambda[held[k]] > above(scaled.r[static_cast<Index>(k)] * change)))
      return std::nullopt;
  const Vector reach = scaled.d * above(radius / std::sqrt(*alpha));
  if (!slacks_are_positive(problem, radii, solution.q, reach, is_held)) return std::nullopt;
  return radius;
}

std::optional<double> sparse_kept_error(const NearestPointProblem& problem, const RadiiOf& radii,
                                        const Solution& solution) {
  const auto kept = residual_of_kept_point(problem, radii, solution);
  if (!kept || problem.A.kind() == MetricKind::dense) return std::nullopt;
  const Balanced scaled = balanced(problem, {});
  if (!is_ordinary(scaled.A.coeffs())) return std::nullopt;
  const auto alpha = least_eigenvalue_below(scaled.A, 0);
  return alpha ? std::optional(imbalance_above(scaled, *kept, *alpha)) : std::nullopt;
}

}  // namespace convex::inline proof
