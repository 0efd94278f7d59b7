#include "convex/nearest_point/optimality/exact_slack.hpp"

#include <algorithm>
#include <cmath>

#include "convex/exact/exact_sum.hpp"

namespace convex {
namespace {

/// Coefficients of an exact sum are fractions with a denominator up to this; doubles tell them apart from
/// others by `close`, and from 0 by `noise`. That is a guess: the sum itself is made without rounding.
constexpr double largest_denominator = 4096, close = 1e-9, noise = 1e-9;

/// The smallest k with x k whole as far as doubles tell, by continued fractions; 0 when it is too large.
double denominator(double x) {
  double before = 0, k = 1, rest = x;
  while (std::abs(x * k - std::round(x * k)) > close * std::max(1.0, std::abs(x)) * k) {
    rest = 1 / (rest - std::floor(rest));
    const double next = std::floor(rest) * k + before;
    before = k;
    k = next;
    if (!(k <= largest_denominator)) return 0;
  }
  return k;
}

bool is_two_sided(const NearestPointProblem& problem, Index a) {
  return std::binary_search(problem.two_sided.begin(), problem.two_sided.end(), a);
}

double entry(const ConstraintRows& U, Index a, Index i) {
  return U.is_sparse() ? U.sparse().coeff(a, i) : U.dense()(a, i);
}

}  // namespace

int slack_sign(const NearestPointProblem& problem, Index a, const Vector& q) {
  ExactSum sum;
  sum.add(-problem.s[a]);
  if (problem.U.is_sparse())
    for (SparseRows::InnerIterator it(problem.U.sparse(), a); it; ++it)
      sum.add_product(it.value(), q[it.col()]);
  else
    for (Index i = 0; i < q.size(); ++i) sum.add_product(problem.U.dense()(a, i), q[i]);
  return sum.sign();
}

std::optional<int> slack_sign_on_edge(const NearestPointProblem& problem, Index p,
                                      const std::vector<Index>& held, const double* coefficients) {
  const Vector weight = problem.A.diagonal().cwiseInverse();
  const auto length = [&](Index a) { return std::sqrt(problem.U.row(a).cwiseAbs2().dot(weight)); };
  const double own = length(p);
  double whole = 1;
  std::vector<std::pair<Index, double>> terms;
  for (std::size_t k = 0; k < held.size(); ++k) {
    if (!(std::abs(coefficients[k]) * length(held[k]) > noise * own)) continue;
    whole *= denominator(coefficients[k] * whole);
    if (!(whole > 0 && whole <= largest_denominator)) return std::nullopt;
    terms.emplace_back(held[k], coefficients[k]);
  }
  for (auto& [a, c] : terms) c = std::round(c * whole);
  for (Index i = 0; i < problem.dimension(); ++i) {
    ExactSum rest;
    rest.add_product(-whole, entry(problem.U, p, i));
    for (const auto& [a, c] : terms) rest.add_product(c, entry(problem.U, a, i));
    if (rest.sign() != 0) return std::nullopt;
  }
  ExactSum slack;
  slack.add_product(-whole, problem.s[p]);
  for (const auto& [a, c] : terms) slack.add_product(c, problem.s[a]);
  return slack.sign();
}

bool keeps_exactly(const NearestPointProblem& problem, const Vector& q, const std::vector<Index>& held,
                   const std::vector<Index>& touched) {
  return std::all_of(held.begin(), held.end(), [&](Index a) { return slack_sign(problem, a, q) == 0; }) &&
         std::all_of(touched.begin(), touched.end(), [&](Index a) {
           const int sign = slack_sign(problem, a, q);
           return sign == 0 || (sign > 0 && !is_two_sided(problem, a));
         });
}

}  // namespace convex
