#include "convex/proved_prox/proved_metric.hpp"

#include <cmath>

#include "convex/exact/positive_definite.hpp"
#include "convex/exact/rounding_bounds.hpp"
#include "convex/exact_program/linear_equations.hpp"
#include "convex/nearest_point/solution.hpp"
#include "convex/proved_prox/doubles/metric_bounds.hpp"

namespace convex::inline proved_prox {
namespace {

/// A full W is solved with in fractions where elimination takes at most this part of `most_word_operations`:
/// n³/3 products of fractions whose digits grow with n, measured.
constexpr double part_for_elimination = 0.0025, of_a_product = 100;

bool is_quick_to_solve(const ExactGram& W) {
  const auto n = static_cast<double>(W.dimension());
  return W.is_diagonal || of_a_product * n * n * n * n <= part_for_elimination * most_word_operations;
}

/// Elimination without a pivot that is not positive.
bool is_definite(std::vector<ExactRow> W) {
  for (std::size_t k = 0; k < W.size(); ++k) {
    const auto pivot = W[k].find(k);
    if (pivot == W[k].end() || sign(pivot->second) <= 0) return false;
    const Fraction d = pivot->second;
    const ExactRow row = W[k];
    for (const auto& [i, value] : row)
      if (i > k) add(W[i], row, -(value / d));
  }
  return true;
}

}  // namespace

Vector nearest(const Fractions& x) {
  Vector made(static_cast<Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) made[static_cast<Index>(i)] = nearest_double(x[i]);
  return made;
}

Fractions fractions(const Vector& x) {
  Fractions made;
  for (const double entry : x) made.push_back(fraction(entry));
  return made;
}

Fractions difference(const Fractions& a, const Fractions& b) {
  Fractions made(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) made[i] = a[i] - b[i];
  return made;
}

ProvedMetric::ProvedMetric(ExactGram W)
    : W_(std::move(W)), doubles_(rounded(W_)), is_exact_(is_quick_to_solve(W_)) {
  if (is_exact_)
    positive_ = is_definite(W_.rows);
  else
    least_ = near_graphs::least_eigenvalue_below(doubles_.dense_gram());
}

bool is_proved_in_integers(const ExactGram& W) {
  const std::size_t n = W.dimension();
  Fractions entries(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (const auto& [j, value] : W.rows[i]) entries[i * n + j] = value;
  const IntegerVector all = exact_vector(entries).numerators;
  IntegerRows rows;
  for (std::size_t i = 0; i < n; ++i) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(i * n);
    rows.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(n));
  }
  return is_positive_definite(rows);
}

double ProvedMetric::norm_above(const Fractions& x) const { return root_above(squared_norm(W_, x)); }

double ProvedMetric::dual_norm_above(const Fractions& c) const {
  if (!is_proved_definite()) return INFINITY;
  if (is_exact_) return root_above(dot(c, solve(c)));
  Fraction square;
  const Fractions e = fractions(doubles_.solve(nearest(c)));
  const Fractions left = difference(c, multiply(W_, e));
  for (const Fraction& entry : left) square = square + entry * entry;
  return above(norm_above(e) + above(root_above(square) / below(std::sqrt(least_))));
}

Fractions ProvedMetric::solve(const Fractions& c) const {
  std::vector<ExactEquation> equations;
  for (std::size_t i = 0; i < c.size(); ++i) equations.push_back({W_.rows[i], c[i]});
  return solve_near(std::move(equations), Fractions(c.size())).value();
}

}  // namespace convex::inline proved_prox
