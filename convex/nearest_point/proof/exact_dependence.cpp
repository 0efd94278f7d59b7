#include "convex/nearest_point/proof/exact_dependence.hpp"

#include <algorithm>

#include "convex/exact/elimination.hpp"
#include "convex/exact/integer_system.hpp"
#include "convex/exact/modular.hpp"

namespace convex {

/// Integers w without a common factor, w_a > 0 for one of them, with Σ w_a U_a = 0 in as many columns as the
/// rows are independent in; empty when there is more than one such w up to a factor.
IntegerVector dependence_of(const ExactProblem& exact) {
  const std::size_t k = exact.U.size(), r = exact.z.size();
  IntegerRows columns(r, IntegerVector(k));
  for (std::size_t a = 0; a < k; ++a)
    for (std::size_t i = 0; i < r; ++i) columns[i][a] = exact.U[a][i];
  const std::vector<std::size_t> chosen = independent_rows(columns, k);
  if (chosen.size() + 1 != k) return {};
  IntegerRows M;
  IntegerVector right;
  for (std::size_t i : chosen) {
    M.emplace_back(columns[i].begin() + 1, columns[i].end());
    right.push_back(-columns[i][0]);
  }
  const auto system = IntegerSystem::prepared(M);
  if (!system) return {};
  const ExactVector others = system->solve(right);
  IntegerVector w{others.denominator};
  w.insert(w.end(), others.numerators.begin(), others.numerators.end());
  for (std::size_t a = 0; a < k; ++a) w[a] *= exact.row_unit[a];
  make_primitive(w);
  return w;
}

bool follows_exactly(const NearestPointProblem& problem, Index a, const std::vector<Index>& others) {
  std::vector<Index> rows{a};
  rows.insert(rows.end(), others.begin(), others.end());
  const ConstraintRows chosen = problem.U.select(rows);
  const auto k = static_cast<Index>(rows.size());
  Matrix U(k, problem.dimension());
  for (Index r = 0; r < k; ++r) U.row(r) = chosen.row(r);
  std::vector<Index> touched;
  for (Index i = 0; i < U.cols(); ++i)
    if ((U.col(i).array() != 0).any()) touched.push_back(i);
  ExactProblem exact;
  exact.z.assign(touched.size(), 0);
  for (Index r = 0; r < k; ++r)
    append_row(exact, Vector(U.row(r).transpose())(touched), problem.s[rows[static_cast<std::size_t>(r)]]);
  const IntegerVector w = dependence_of(exact);
  if (w.empty() || w[0].is_zero()) return false;
  // `w` is of the rows themselves; those of `exact` are theirs times row_unit.
  Fraction left{};
  for (std::size_t r = 0; r < w.size(); ++r)
    left = left + Fraction{w[r], 1} * Fraction{exact.s[r], exact.row_unit[r]};
  for (std::size_t i = 0; i < touched.size(); ++i) {
    Fraction sum{};
    for (std::size_t r = 0; r < w.size(); ++r)
      if (!exact.U[r][i].is_zero())
        sum = sum + Fraction{w[r], 1} * Fraction{exact.U[r][i], exact.row_unit[r]};
    if (sign(sum) != 0) return false;
  }
  const bool two_sided = std::binary_search(problem.two_sided.begin(), problem.two_sided.end(), a);
  return two_sided ? sign(left) == 0 : sign(left) * w[0].sign() <= 0;
}

}  // namespace convex
