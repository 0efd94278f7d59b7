#include "convex/nearest_point/optimality/exact_slack.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/dense/dense_kernels.hpp"
#include "convex/double_double.hpp"
#include "convex/exact/exact_sum.hpp"
#include "convex/exact/grid_sum.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline optimality {
namespace {

/// Sums of a few of the numbers on a grid are exact in doubles when these are at most so many of its steps.
constexpr double most_steps = 0x1p36, most_terms = 0x1p16;

/// Coefficients of an exact sum are fractions with a denominator up to this; doubles tell them apart from
/// others by `close`. That is a guess: the sum itself is made without rounding.
constexpr double largest_denominator = 4096, close = 1e-9;
/// Divided by all numbers up to ten, and by sixteen.
constexpr double many_denominators = 5040;

/// The nearest whole number, of |x| < 2^51; a call of the library's function takes longer.
double nearest_whole(double x) {
  constexpr double shift = 0x1.8p52;
  return (x + shift) - shift;
}

/// The smallest k with x k whole as far as doubles tell, by continued fractions; 0 when it is too large.
double denominator(double x) {
  double before = 0, k = 1, rest = x;
  if (!(std::abs(x) < most_terms)) return 0;
  while (std::abs(x * k - nearest_whole(x * k)) > close * std::max(1.0, std::abs(x)) * k) {
    rest = 1 / (rest - std::floor(rest));
    const double next = std::floor(rest) * k + before;
    before = k;
    k = next;
    if (!(k <= largest_denominator)) return 0;
  }
  return k;
}

/// Whether n numbers lie on one grid that is no finer than their largest over `most_steps`.
bool is_on_some_grid(Index n, const double* x) {
  const DenseKernels& kernels = dense_kernels();
  const double largest = kernels.largest_size(n, x);
  if (!std::isnormal(largest)) return largest == 0;
  const double grid = std::ldexp(1, std::ilogb(largest) + 1) / most_steps;
  // x + shift rounds x to the grid.
  return std::isnormal(grid) && kernels.is_on_grid(n, x, 1.5 * grid / unit_roundoff * 0.5);
}

double entry(const ConstraintRows& U, Index a, Index i) {
  return U.is_sparse() ? U.sparse().coeff(a, i) : U.dense()(a, i);
}

/// u_a·q - s_a.
ExactSum exact_slack(const NearestPointProblem& problem, Index a, const Point& q) {
  ExactSum sum;
  sum.add(-problem.s[a]);
  problem.U.for_each_entry(a, [&](Index i, double u) { sum.add_product(u, q[i]); });
  return sum;
}

}  // namespace

SlackOnEdge::SlackOnEdge(const NearestPointProblem& problem, const double* row_scale)
    : problem_(problem), row_scale_(row_scale) {
  const Index room = std::min(problem.dimension(), problem.rows());
  rows_.resize(at(room));
  coefficients_.resize(at(room));
  side_by_side_.resize(at(9 * room + 8 * problem.dimension()));
  if (problem.U.is_sparse() || problem.rows() == 0) return;
  rows_on_grid_ = is_on_some_grid(problem.U.dense().size(), problem.U.dense().data());
}

void SlackOnEdge::begin() { loads_on_grid_ = is_on_some_grid(problem_.s.size(), problem_.s.data()); }

/// Whether Σ c_k u_k = whole u_p for the terms, not one bit off.
bool SlackOnEdge::cancels(Index p, double whole) const {
  if (rows_on_grid_ && sum_ <= most_terms)
    return dense_kernels().cancels(problem_.dimension(), problem_.U.dense().data(), p, whole,
                                   static_cast<Index>(count_), rows_.data(), coefficients_.data());
  for (Index i = 0; i < problem_.dimension(); ++i) {
    ExactSum rest;
    rest.add_product(-whole, entry(problem_.U, p, i));
    for (std::size_t k = 0; k < count_; ++k)
      rest.add_product(coefficients_[k], entry(problem_.U, rows_[k], i));
    if (rest.sign() != 0) return false;
  }
  return true;
}

/// (Σ c_k s_k - whole s_p) / whole over the terms.
double SlackOnEdge::slack_of_loads(Index p, double whole) const {
  if (loads_on_grid_ && sum_ <= most_terms) {
    double sum = 0 - whole * problem_.s[p];
    for (std::size_t k = 0; k < count_; ++k) sum += coefficients_[k] * problem_.s[rows_[k]];
    return sum / whole;
  }
  DoubleDouble sum = two_product(-whole, problem_.s[p]);
  bool is_exact = sum.lo == 0;
  for (std::size_t k = 0; k < count_; ++k) {
    const DoubleDouble term = two_product(coefficients_[k], problem_.s[rows_[k]]),
                       next = two_sum(sum.hi, term.hi);
    is_exact = is_exact && term.lo == 0 && next.lo == 0;
    sum.hi = next.hi;
  }
  if (is_exact) return sum.hi / whole;
  ExactSum slack;
  slack.add_product(-whole, problem_.s[p]);
  for (std::size_t k = 0; k < count_; ++k) slack.add_product(coefficients_[k], problem_.s[rows_[k]]);
  return quotient_with_sign(slack, whole);
}

std::optional<double> SlackOnEdge::slack(Index p, const Index* held, Index count,
                                         const double* coefficients) {
  const double least = zero_coefficient * row_scale_[p];
  double whole = 1, *const c = coefficients_.data();
  Index* const rows = rows_.data();
  Index terms = 0;
  for (Index k = 0; k < count; ++k) {  // without a branch, for which terms there are cannot be foreseen
    rows[terms] = held[k];
    c[terms] = coefficients[k];
    terms += std::abs(coefficients[k]) * row_scale_[held[k]] > least;
  }
  for (Index k = 0; k < terms; ++k) {
    whole *= denominator(c[k] * whole);
    if (!(whole > 0 && whole <= largest_denominator)) return std::nullopt;
  }
  double sum = whole;
  for (Index k = 0; k < terms; ++k) {
    c[k] = nearest_whole(c[k] * whole);
    sum += std::abs(c[k]);
  }
  count_ = at(terms);
  sum_ = sum;
  if (!cancels(p, whole)) return std::nullopt;
  return slack_of_loads(p, whole);
}

/// Most rows that are no sum show it in their first entry.
bool SlackOnEdge::shows_that_it_is_none(Index p, const Index* held, Index count,
                                        const double* coefficients) const {
  double rest = entry(problem_.U, p, 0);
  for (Index k = 0; k < count; ++k) rest -= coefficients[k] * entry(problem_.U, held[k], 0);
  return std::abs(rest) > zero_coefficient * row_scale_[p] * std::sqrt(problem_.A.diagonal()[0]);
}

/// Fractions with small denominators are tried for all rows at once, as whole numbers over one that these
/// divide, where sums of few rows have no rounding.
void SlackOnEdge::slacks(std::span<const Index> rows, const double* X, const Index* held, Index count,
                         const double* coefficients, std::optional<double>* into) {
  alignas(64) double s[8] = {}, least[8] = {}, size[8], rest[8], load[8];
  for (std::size_t l = 0; l < 8; ++l) size[l] = std::numeric_limits<double>::infinity();
  const Index n = problem_.dimension();
  double *const whole = side_by_side_.data(), *const alone = whole + 8 * count, *const all = alone + count;
  if (rows_on_grid_) {
    for (std::size_t l = 0; l < rows.size(); ++l) {
      s[l] = many_denominators * problem_.s[rows[l]];
      least[l] = many_denominators * zero_coefficient * row_scale_[rows[l]];
    }
    for (Index k = 0; k < 8 * count; ++k) whole[k] = many_denominators * coefficients[k];
    for (Index i = 0; i < 8 * n; ++i) all[i] = many_denominators * X[i];
    dense_kernels().whole_sums(n, all, s, problem_.U.dense().data(), problem_.s.data(), count, held,
                               row_scale_, least, close, whole, rows_.data(), size, rest, load);
  }
  for (std::size_t l = 0; l < rows.size(); ++l) {
    const bool is_whole = size[l] + many_denominators <= most_terms;
    if (is_whole && (rest[l] != 0 || loads_on_grid_)) {
      into[l] = rest[l] == 0 ? std::optional(load[l] / many_denominators) : std::nullopt;
      continue;
    }
    for (Index k = 0; k < count; ++k) alone[k] = coefficients[8 * k + static_cast<Index>(l)];
    into[l] = is_whole || !shows_that_it_is_none(rows[l], held, count, alone)
                  ? slack(rows[l], held, count, alone)
                  : std::nullopt;
  }
}

bool keeps_rows(const NearestPointProblem& problem, const Point& q, std::span<const Index> held,
                std::span<const Index> degenerate, double* slacks) {
  const auto is_kept = [&](Index a, double slack) {
    return slack == 0 || (slack > 0 && !problem.is_two_sided(a));
  };
  const bool at_rest = (q.array() == 0).all();
  const GridSum on_grid(q);
  // A slack that is too small for a double has its sign all the same.
  const auto slack_of = [&](Index a) {
    if (at_rest) return 0 - problem.s[a];
    if (!problem.U.is_sparse())
      if (const auto slack = on_grid.value(problem.U.dense().data() + a * q.size(), problem.s[a]))
        return *slack;
    return slack_at(problem, a, q);
  };
  return std::all_of(held.begin(), held.end(), [&](Index a) { return slack_of(a) == 0; }) &&
         std::all_of(degenerate.begin(), degenerate.end(),
                     [&](Index a) { return is_kept(a, *slacks++ = slack_of(a)); });
}

std::optional<Vector> slacks_if_kept(const NearestPointProblem& problem, const Point& q,
                                     std::span<const Index> held, std::span<const Index> degenerate) {
  Vector slacks(static_cast<Index>(degenerate.size()));
  return keeps_rows(problem, q, held, degenerate, slacks.data()) ? std::optional(std::move(slacks))
                                                                 : std::nullopt;
}

bool is_in_balance(const NearestPointProblem& problem, const Point& q, const DoubleDoubleVector& lambda) {
  const Metric& A = problem.A;
  std::vector<ExactSum> rest(at(q.size()));
  for (Index i = 0; i < q.size(); ++i) rest[at(i)].add(problem.z[i]);
  const auto subtract = [&](Index i, Index j, double a_ij) { rest[at(i)].add_product(-a_ij, q[j]); };
  for (Index j = 0; j < q.size(); ++j) {
    if (A.kind() == MetricKind::dense)
      for (Index i = 0; i < q.size(); ++i) subtract(i, j, A.dense_gram()(i, j));
    else if (A.kind() == MetricKind::sparse)
      for (SparseMatrix::InnerIterator it(A.sparse_gram(), j); it; ++it) subtract(it.row(), j, it.value());
    else
      subtract(j, j, A.diagonal()[j]);
  }
  for (Index a = 0; a < problem.rows(); ++a) {
    if (lambda.hi[a] == 0) continue;
    problem.U.for_each_entry(a, [&](Index i, double u) {
      rest[at(i)].add_product(u, lambda.hi[a]);
      rest[at(i)].add_product(u, lambda.lo[a]);
    });
  }
  return std::all_of(rest.begin(), rest.end(), [](const ExactSum& sum) { return sum.sign() == 0; });
}

double quotient_with_sign(const ExactSum& sum, double divisor) {
  const double size = std::max(std::abs(sum.value() / divisor), std::numeric_limits<double>::denorm_min());
  return sum.sign() * std::copysign(size, divisor);
}

double slack_at(const NearestPointProblem& problem, Index a, const Point& q) {
  return quotient_with_sign(exact_slack(problem, a, q), 1);
}

int sign_of_slack(const NearestPointProblem& problem, Index a, const Point& q) {
  return exact_slack(problem, a, q).sign();
}

}  // namespace convex::inline optimality
