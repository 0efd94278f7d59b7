#include "tests/oracles/rational_kkt.hpp"

#include <algorithm>
#include <cmath>

namespace oracles {
using convex::Index;

convex::Matrix gram(const convex::Metric& A) {
  const Index n = A.dimension();
  if (A.kind() == convex::MetricKind::dense) return A.dense_gram();
  if (A.kind() == convex::MetricKind::sparse) return convex::Matrix(A.sparse_gram());
  return A.diagonal().asDiagonal() * convex::Matrix::Identity(n, n);
}

RationalPoint solve_kkt(const convex::NearestPointProblem& problem, const std::vector<Index>& rows) {
  const auto n = static_cast<std::size_t>(problem.dimension()), k = rows.size();
  const convex::Matrix A = gram(problem.A);
  std::vector<RationalVector> M(n + k, RationalVector(n + k + 1));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) M[i][j] = A(static_cast<Index>(i), static_cast<Index>(j));
    M[i][n + k] = problem.z[static_cast<Index>(i)];
  }
  for (std::size_t r = 0; r < k; ++r) {
    const convex::Vector u = problem.U.row(rows[r]);
    for (std::size_t i = 0; i < n; ++i) {
      M[n + r][i] = u[static_cast<Index>(i)];
      M[i][n + r] = -M[n + r][i];
    }
    M[n + r][n + k] = problem.s[rows[r]];
  }
  const std::vector<std::size_t> pivots = row_reduce(M, n + k);
  RationalPoint point{RationalVector(n), RationalVector(static_cast<std::size_t>(problem.rows()))};
  for (std::size_t row = 0; row < pivots.size(); ++row) {
    if (pivots[row] < n)
      point.q[pivots[row]] = M[row][n + k];
    else
      point.lambda[static_cast<std::size_t>(rows[pivots[row] - n])] = M[row][n + k];
  }
  return point;
}

bool is_exact_solution(const convex::NearestPointProblem& problem, const RationalPoint& point) {
  const convex::Matrix A = gram(problem.A);
  RationalVector balance(point.q.size());
  for (Index i = 0; i < problem.dimension(); ++i) {
    balance[static_cast<std::size_t>(i)] = -Rational(problem.z[i]);
    for (Index j = 0; j < problem.dimension(); ++j)
      balance[static_cast<std::size_t>(i)] += Rational(A(i, j)) * point.q[static_cast<std::size_t>(j)];
  }
  for (Index a = 0; a < problem.rows(); ++a) {
    const convex::Vector u = problem.U.row(a);
    const Rational& lambda = point.lambda[static_cast<std::size_t>(a)];
    Rational slack = -Rational(problem.s[a]);
    for (Index i = 0; i < problem.dimension(); ++i) {
      slack += Rational(u[i]) * point.q[static_cast<std::size_t>(i)];
      balance[static_cast<std::size_t>(i)] -= lambda * Rational(u[i]);
    }
    const bool two_sided = std::count(problem.two_sided.begin(), problem.two_sided.end(), a) > 0;
    if (two_sided ? slack != 0 : slack < 0 || lambda < 0 || lambda * slack != 0) return false;
  }
  return std::all_of(balance.begin(), balance.end(), [](const Rational& b) { return b == 0; });
}

double relative_error(const convex::NearestPointProblem& problem, const convex::Vector& q,
                      const RationalPoint& exact, double scale) {
  const convex::Matrix A = gram(problem.A);
  RationalVector difference(exact.q.size());
  for (std::size_t i = 0; i < difference.size(); ++i)
    difference[i] = Rational(q[static_cast<Index>(i)]) - exact.q[i];
  Rational square = 0;
  for (std::size_t i = 0; i < difference.size(); ++i)
    for (std::size_t j = 0; j < difference.size(); ++j)
      square += difference[i] * Rational(A(static_cast<Index>(i), static_cast<Index>(j))) * difference[j];
  return std::sqrt(square.get_d()) / scale;
}

bool is_exact_farkas_witness(const convex::NearestPointProblem& problem, const RationalVector& w) {
  RationalVector combination(static_cast<std::size_t>(problem.dimension()));
  Rational gap = 0;
  for (Index a = 0; a < problem.rows(); ++a) {
    const Rational& weight = w[static_cast<std::size_t>(a)];
    const bool two_sided = std::count(problem.two_sided.begin(), problem.two_sided.end(), a) > 0;
    if (weight < 0 && !two_sided) return false;
    if (weight == 0) continue;
    const convex::Vector u = problem.U.row(a);
    for (Index i = 0; i < u.size(); ++i) combination[static_cast<std::size_t>(i)] += weight * Rational(u[i]);
    gap += weight * Rational(problem.s[a]);
  }
  return gap > 0 &&
         std::all_of(combination.begin(), combination.end(), [](const Rational& c) { return c == 0; });
}

bool is_farkas_witness(const convex::NearestPointProblem& problem, const convex::Vector& w, double slack) {
  RationalVector combination(static_cast<std::size_t>(problem.dimension()));
  Rational gap = 0, largest = 0;
  for (Index a = 0; a < problem.rows(); ++a) {
    const bool two_sided = std::count(problem.two_sided.begin(), problem.two_sided.end(), a) > 0;
    if (w[a] < 0 && !two_sided) return false;
    const convex::Vector u = problem.U.row(a);
    for (Index i = 0; i < u.size(); ++i) {
      const Rational term = Rational(w[a]) * Rational(u[i]);
      combination[static_cast<std::size_t>(i)] += term;
      largest = std::max(largest, Rational(abs(term)));
    }
    gap += Rational(w[a]) * Rational(problem.s[a]);
  }
  return gap > 0 && std::all_of(combination.begin(), combination.end(),
                                [&](const Rational& c) { return abs(c) <= Rational(slack) * largest; });
}

}  // namespace oracles
