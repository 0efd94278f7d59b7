#include "convex/nearest_point/proof/exact_problem.hpp"

#include <cmath>
#include <limits>

#include "convex/cones/exact_metric.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/exact/positive_definite.hpp"
#include "convex/invalid_input.hpp"

namespace convex::inline proof {
namespace {

constexpr int mantissa_bits = 53;

/// The exponent of the last bit set in x, or `highest` for 0.
int last_bit(double x, int highest) {
  if (x == 0) return highest;
  int exponent = 0;
  const auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), mantissa_bits));
  return exponent - mantissa_bits + __builtin_ctzll(static_cast<unsigned long long>(digits));
}

/// x 2^-exponent, an integer.
Integer integer(double x, int exponent) {
  int own = 0;
  const auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &own), mantissa_bits));
  if (digits == 0) return 0;
  const int shift = own - mantissa_bits - exponent;
  if (shift >= 0) return Integer::shifted(digits, static_cast<unsigned long>(shift));
  return digits / (std::int64_t{1} << static_cast<unsigned>(-shift));
}

Matrix gram(const Metric& A) {
  if (A.kind() == MetricKind::dense) return A.dense_gram();
  if (A.kind() == MetricKind::sparse) return Matrix(A.sparse_gram());
  return A.diagonal().asDiagonal();
}

template <class Numbers>
int last_bit_of_all(const Numbers& numbers, int exponent) {
  for (Index i = 0; i < numbers.size(); ++i)
    exponent = std::min(exponent, last_bit(numbers.data()[i], exponent));
  return exponent;
}

template <class Numbers>
IntegerVector integers(const Numbers& numbers, int exponent) {
  IntegerVector all;
  all.reserve(static_cast<std::size_t>(numbers.size()));
  for (Index i = 0; i < numbers.size(); ++i) all.push_back(integer(numbers[i], exponent));
  return all;
}

void require_definite(const ExactProblem& problem) {
  if (!is_positive_definite(problem.A))
    throw InvalidInput(
        "A: not positive definite at its exact value (doubles may be too coarse for it); give exact entries, "
        "\"1/3\", or a better conditioned A");
}

Integer shifted_one(int exponent) { return Integer::shifted(1, static_cast<unsigned long>(exponent)); }

}  // namespace

void append_row(ExactProblem& problem, const Vector& row, double s) {
  const int own = last_bit_of_all(row, std::min(0, last_bit(s, 0)));
  problem.U.push_back(integers(row, own));
  problem.s.push_back(integer(s, own));
  problem.row_unit.push_back(shifted_one(-own));
}

ExactProblem exact_problem(const NearestPointProblem& problem) {
  ExactProblem exact;
  const Matrix A = gram(problem.A);
  const int inertia = last_bit_of_all(problem.z, last_bit_of_all(A, 0));
  for (Index i = 0; i < A.rows(); ++i) exact.A.push_back(integers(A.col(i), inertia));
  exact.z = integers(problem.z, inertia);
  exact.unit = shifted_one(-inertia);
  for (Index a = 0; a < problem.rows(); ++a) append_row(exact, problem.U.row(a), problem.s[a]);
  exact.two_sided = problem.two_sided;
  require_definite(exact);
  return exact;
}

ExactProblem exact_problem(const ExactRows& A, const ExactVector& z, const ExactRows& U, const ExactVector& s,
                           std::vector<Index> two_sided) {
  ExactProblem exact = exact_problem_of_definite(A, z, U, s, std::move(two_sided));
  require_definite(exact);
  return exact;
}

ExactProblem exact_problem_of_definite(const ExactRows& A, const ExactVector& z, const ExactRows& U,
                                       const ExactVector& s, std::vector<Index> two_sided) {
  const std::size_t n = A.size();
  ExactProblem exact;
  require_symmetric(A);
  ExactRows inertia = A;
  inertia.push_back(z);
  IntegerMatrix M = over_one_denominator(inertia);
  exact.z = std::move(M.rows.back());
  M.rows.pop_back();
  bool symmetric = true;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) symmetric = symmetric && M.rows[i][j] == M.rows[j][i];
  exact.unit = M.denominator;
  exact.A = M.rows;
  if (!symmetric) {
    exact.unit *= 2;
    for (Integer& entry : exact.z) entry *= 2;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) exact.A[i][j] = M.rows[i][j] + M.rows[j][i];
  }
  for (std::size_t a = 0; a < U.size(); ++a) {
    IntegerMatrix row = over_one_denominator({U[a], ExactVector{{s.numerators[a]}, s.denominator}});
    exact.U.push_back(std::move(row.rows[0]));
    exact.s.push_back(std::move(row.rows[1][0]));
    exact.row_unit.push_back(std::move(row.denominator));
    IntegerVector common = exact.U.back();
    common.push_back(exact.s.back());
    common.push_back(exact.row_unit.back());
    make_primitive(common);
    exact.row_unit.back() = std::move(common.back());
    common.pop_back();
    exact.s.back() = std::move(common.back());
    common.pop_back();
    exact.U.back() = std::move(common);
  }
  exact.two_sided = std::move(two_sided);
  return exact;
}

NearestPointProblem rounded(const ExactProblem& problem) {
  const Index n = problem.dimension(), m = problem.rows();
  Matrix A(n, n);
  for (Index i = 0; i < n; ++i) A.col(i) = nearest({problem.A[at(i)], problem.unit});
  RowMatrix U(m, n);
  Vector s(m);
  for (Index a = 0; a < m; ++a) {
    const auto k = at(a);
    U.row(a) = nearest({problem.U[k], problem.row_unit[k]});
    s[a] = nearest_quotient(problem.s[k], problem.row_unit[k]);
  }
  return {Metric::dense(A), nearest({problem.z, problem.unit}), ConstraintRows(std::move(U)), std::move(s),
          problem.two_sided};
}

ExactVector reaction(const ExactProblem& problem, const ExactVector& lambda) {
  const std::size_t n = problem.z.size();
  std::vector<Fraction> sum(n);
  IntegerVector column(problem.U.size());
  // Σ lambda_a U_a / row_unit_a; multipliers over their rows' units first, so that entries are plain sums.
  std::vector<Fraction> weight;
  for (std::size_t a = 0; a < problem.U.size(); ++a)
    weight.push_back(lowest_terms({lambda.numerators[a], problem.row_unit[a]}));
  const ExactVector w = exact_vector(weight);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t a = 0; a < problem.U.size(); ++a) column[a] = problem.U[a][i];
    sum[i] = lowest_terms({dot(column, w.numerators), w.denominator * lambda.denominator});
  }
  return exact_vector(sum);
}

Fraction squared_distance(const ExactProblem& problem, const ExactVector& x, const ExactVector& y) {
  ExactVector difference{{}, x.denominator * y.denominator};
  for (std::size_t i = 0; i < x.numerators.size(); ++i)
    difference.numerators.push_back(x.numerators[i] * y.denominator - y.numerators[i] * x.denominator);
  return squared_norm(problem, difference);
}

Fraction squared_norm(const ExactProblem& problem, const ExactVector& x) {
  IntegerVector product;
  for (const IntegerVector& row : problem.A) product.push_back(dot(row, x.numerators));
  return {dot(product, x.numerators), x.denominator * x.denominator * problem.unit};
}

}  // namespace convex::inline proof
