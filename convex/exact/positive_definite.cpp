#include "convex/exact/positive_definite.hpp"

#include <gmp.h>

#include <cmath>

#include "convex/exact/elimination.hpp"
#include "convex/linear_algebra/cholesky.hpp"

namespace convex::inline exact_arithmetic {
namespace {

/// Bits of an entry of X against the largest of its row: a dominant diagonal needs few.
constexpr int kept_bits = 30;

/// D^-½ A D^-½ in doubles, D the diagonal of A; whether every entry on the diagonal is positive.
bool scaled(const IntegerRows& A, Matrix& S, Vector& root) {
  const auto n = static_cast<Index>(A.size());
  root.resize(n);
  S.resize(n, n);
  for (Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (A[k][k].sign() <= 0) return false;
    root[i] = std::sqrt(nearest_quotient(A[k][k], 1));
  }
  if (!root.allFinite()) return false;
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      S(i, j) = nearest_quotient(A[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)], 1) / root[i] /
                root[j];
  return true;
}

/// Rows of X over the roots of the diagonal, in integers; each row may be taken times any positive number.
IntegerRows rounded_rows(const Matrix& X, const Vector& root) {
  IntegerRows rows;
  for (Index i = 0; i < X.rows(); ++i) {
    const Vector row = X.row(i).transpose().cwiseQuotient(root);
    // Large columns (small roots) need fine steps: the step is set by what it does to X A Xᵀ.
    int finest = 0;
    std::frexp(X.row(i).cwiseAbs().maxCoeff() / root.maxCoeff(), &finest);
    IntegerVector entries;
    for (Index j = 0; j < row.size(); ++j) {
      int own = 0;
      const double mantissa = std::frexp(row[j], &own);
      const auto digits = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
      const long shift = static_cast<long>(own) - 53 - (finest - kept_bits);
      entries.push_back(shift >= 0    ? Integer::shifted(digits, static_cast<unsigned long>(shift))
                        : shift > -63 ? Integer(digits / (std::int64_t{1} << static_cast<unsigned>(-shift)))
                                      : Integer(0));
    }
    rows.push_back(std::move(entries));
  }
  return rows;
}

bool dominant_diagonal(const IntegerRows& A, const IntegerRows& X) {
  const std::size_t n = A.size();
  IntegerRows B;  // i, j, |entry (i, j) of X A Xᵀ|, j < i
  std::vector<Integer> others(n, 0), own(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    IntegerVector y;
    for (const IntegerVector& row : A) y.push_back(dot(row, X[i]));
    for (std::size_t j = 0; j <= i; ++j) {
      Integer entry = dot(y, X[j]);
      if (i == j) {
        own[i] = entry;
      } else {
        if (entry.sign() < 0) entry = -entry;
        B.push_back({static_cast<std::int64_t>(i), static_cast<std::int64_t>(j), std::move(entry)});
      }
    }
  }
  // The rows of X have any lengths: compare |b_ij| with own_i and own_j after scaling rows by powers of two.
  std::vector<unsigned long> half(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (own[i].sign() <= 0) return false;
    half[i] = own[i].bits() / 2;
  }
  unsigned long longest = 0;
  for (unsigned long bits : half) longest = std::max(longest, bits);
  for (const IntegerVector& entry : B) {
    const auto i = static_cast<std::size_t>(entry[0].word()), j = static_cast<std::size_t>(entry[1].word());
    const auto shift = 2 * longest - half[i] - half[j];
    const Integer scaled_entry = entry[2] * Integer::shifted(1, shift);
    others[i] += scaled_entry;
    others[j] += scaled_entry;
  }
  for (std::size_t i = 0; i < n; ++i)
    if (own[i] * Integer::shifted(1, 2 * (longest - half[i])) <= others[i]) return false;
  return true;
}

/// Bareiss' elimination: whether all leading minors are positive; column(k, A, last) sees the entries below
/// pivot k, the minor, and the minor before it.
template <class Column>
bool leading_minors_positive(IntegerRows A, Column column) {
  Integer last = 1;
  for (std::size_t k = 0; k < A.size(); ++k) {
    if (A[k][k].sign() <= 0) return false;
    column(k, A, last);
    for (std::size_t i = k + 1; i < A.size(); ++i)
      for (std::size_t j = k + 1; j <= i; ++j)
        A[i][j] = exact_quotient(A[k][k] * A[i][j] - A[i][k] * A[j][k], last);
    last = A[k][k];
  }
  return true;
}

}  // namespace

bool is_positive_definite(const IntegerRows& A) {
  Matrix S;
  Vector root;
  if (scaled(A, S, root)) {
    const linear_algebra::Cholesky factor(S);
    if (factor.is_definite()) {
      Matrix X = Matrix::Identity(S.rows(), S.rows());
      factor.solve_lower_in_place(X);
      if (X.allFinite() && dominant_diagonal(A, rounded_rows(X, root))) return true;
    }
  }
  return leading_minors_positive(A, [](std::size_t, const IntegerRows&, const Integer&) {});
}

double cholesky_work(Index n, std::size_t bits) {
  const auto size = static_cast<double>(n);
  const double words = 1 + size * static_cast<double>(bits) / (2 * 64);  // of an entry half way
  return size * size * size / 3 * words * words;
}

std::optional<Matrix> cholesky_factor(const IntegerRows& A, double most) {
  std::size_t bits = 0;
  for (const IntegerVector& row : A)
    for (const Integer& entry : row) bits = std::max(bits, entry.bits());
  if (cholesky_work(static_cast<Index>(A.size()), bits) > most) return std::nullopt;
  Matrix L = Matrix::Zero(static_cast<Index>(A.size()), static_cast<Index>(A.size()));
  const auto keep = [&](std::size_t k, const IntegerRows& left, const Integer& last) {
    const double pivot = std::sqrt(nearest_quotient(left[k][k], last));
    for (std::size_t i = k; i < A.size(); ++i)
      L(static_cast<Index>(i), static_cast<Index>(k)) = nearest_quotient(left[i][k], left[k][k]) * pivot;
  };
  if (!leading_minors_positive(A, keep)) return std::nullopt;
  return L;
}

}  // namespace convex::inline exact_arithmetic
