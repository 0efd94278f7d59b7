#include <cmath>

#include "convex/exact_program/program_of_call.hpp"
#include "convex/linear_algebra/symmetric_eigen.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex::inline proved_prox::pairs {
namespace {

/// Square matrices of fractions, by rows.
using Square = std::vector<Fractions>;

Square unstacked(const Fractions& x) {
  const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(x.size()))));
  Square M(n, Fractions(n));
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) M[i][j] = x[j * n + i];
  return M;
}

Fractions stacked(const Square& M) {
  Fractions x;
  for (std::size_t j = 0; j < M.size(); ++j)
    for (std::size_t i = 0; i < M.size(); ++i) x.push_back(M[i][j]);
  return x;
}

Square symmetric_part(const Square& M) {
  Square S = M;
  for (std::size_t i = 0; i < M.size(); ++i)
    for (std::size_t j = 0; j < M.size(); ++j) S[i][j] = (M[i][j] + M[j][i]) * Fraction{1, 2};
  return S;
}

bool is_psd(const Square& M) {
  std::vector<ExactRow> rows(M.size());
  for (std::size_t i = 0; i < M.size(); ++i)
    for (std::size_t j = 0; j < M.size(); ++j) add(rows[i], j, M[i][j]);
  return exact_programs::is_semidefinite(rows);
}

/// M += factor p pᵀ.
void add_square(Square& M, const Fraction& factor, const Fractions& p) {
  for (std::size_t i = 0; i < M.size(); ++i)
    for (std::size_t j = 0; j < M.size(); ++j) M[i][j] = M[i][j] + factor * p[i] * p[j];
}

Matrix in_doubles(const Square& M) {
  const auto n = static_cast<Index>(M.size());
  Matrix made(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      made(i, j) = nearest_double(M[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
  return made;
}

/// det M of a symmetric matrix by elimination; none unless all pivots are positive.
std::optional<Fraction> positive_determinant(Square M) {
  Fraction product{1};
  for (std::size_t k = 0; k < M.size(); ++k) {
    if (sign(M[k][k]) <= 0) return std::nullopt;
    product = product * M[k][k];
    for (std::size_t i = k + 1; i < M.size(); ++i) {
      const Fraction factor = M[i][k] / M[k][k];
      for (std::size_t j = k; j < M.size(); ++j) M[i][j] = M[i][j] - factor * M[k][j];
    }
  }
  return product;
}

}  // namespace

/// X = Σ d_k p_k p_kᵀ and V = -Σ e_k q_k q_kᵀ with the p at right angles to the q without rounding: the
/// eigenvectors of X + V that doubles find, made orthogonal in fractions (Gram and Schmidt). What is
/// antisymmetric of V is free.
MaybePair of_psd_cone(const Fractions& x, const Fractions& v) {
  const Square X = symmetric_part(unstacked(x)), full = unstacked(v), V = symmetric_part(full);
  const std::size_t n = X.size();
  Square both = X;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) both[i][j] = X[i][j] + V[i][j];
  const linear_algebra::SymmetricEigen eigen(in_doubles(both));
  if (!eigen.found) return std::nullopt;
  std::vector<Fractions> basis;
  Square point(n, Fractions(n)), polar = point;
  for (std::size_t k = 0; k < n; ++k) {
    Fractions p = fractions(Vector(eigen.vectors.col(static_cast<Index>(k))));
    for (const Fractions& earlier : basis)
      p = difference(p, multiple_of(dot(p, earlier) / square_of(earlier), earlier));
    const Fraction square = square_of(p);
    if (sign(square) == 0) return std::nullopt;
    const auto form = [&](const Square& M) {
      Fraction sum;
      for (std::size_t i = 0; i < n; ++i) sum = sum + p[i] * dot(M[i], p);
      return sum / (square * square);
    };
    const Fraction of_x = form(X), of_v = form(V);
    if (sign(of_x + of_v) > 0) {
      if (sign(of_x) > 0) add_square(point, of_x, p);
    } else if (sign(of_v) < 0) {
      add_square(polar, of_v, p);
    }
    basis.push_back(std::move(p));
  }
  Square negative = polar;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      negative[i][j] = -polar[i][j];
      polar[i][j] = polar[i][j] + full[i][j] - V[i][j];
    }
  if (!is_psd(point) || !is_psd(negative)) return std::nullopt;
  return ProofPair{stacked(point), stacked(polar), only(Fraction{}), only(Fraction{}), true};
}

/// -log det X on symmetric X, and -n - log det(-V) with the symmetric part of V.
MaybePair of_neg_log_det(const Fractions& x, const Fractions& v) {
  const Square X = symmetric_part(unstacked(x));
  Square minus_V = symmetric_part(unstacked(v));
  for (Fractions& row : minus_V) row = multiple_of(Fraction{-1}, row);
  const auto of_x = positive_determinant(X), of_v = positive_determinant(minus_V);
  if (!of_x || !of_v) return std::nullopt;
  const Ball none = ball(Fraction{}), n = ball(Fraction{static_cast<std::int64_t>(X.size())});
  const auto f_x = interval(none - log(ball(*of_x))), f_v = interval(none - n - log(ball(*of_v)));
  if (!f_x || !f_v) return std::nullopt;
  return ProofPair{stacked(X), v, *f_x, *f_v, false};
}

}  // namespace convex::inline proved_prox::pairs
