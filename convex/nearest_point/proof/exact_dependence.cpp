#include "convex/nearest_point/proof/exact_dependence.hpp"

#include <algorithm>
#include <optional>

#include "convex/exact/elimination.hpp"
#include "convex/exact/modular.hpp"

namespace convex::inline proof {

RestrictedRows restricted_rows(const NearestPointProblem& problem, const std::vector<Index>& rows) {
  const ConstraintRows chosen = problem.U.select(rows);
  RowMatrix U(static_cast<Index>(rows.size()), problem.dimension());
  for (Index r = 0; r < U.rows(); ++r) U.row(r) = chosen.row(r);
  std::vector<Index> with_entries;
  for (Index i = 0; i < U.cols(); ++i)
    if ((U.col(i).array() != 0).any()) with_entries.push_back(i);
  return {U(Eigen::all, with_entries), problem.s(rows)};
}

ExactProblem as_integers(const RestrictedRows& rows) {
  ExactProblem exact;
  exact.z.assign(at(rows.U.cols()), 0);
  for (Index r = 0; r < rows.U.rows(); ++r) append_row(exact, rows.U.row(r), rows.s[r]);
  return exact;
}

std::optional<RowBasis> RowBasis::of(const IntegerRows& rows, std::size_t dimension) {
  IntegerRows columns(dimension), square;
  for (std::size_t i = 0; i < dimension; ++i)
    for (const IntegerVector& row : rows) columns[i].push_back(row[i]);
  std::vector<std::size_t> coordinates = independent_rows(columns, rows.size());
  if (coordinates.size() != rows.size()) return std::nullopt;
  for (std::size_t i : coordinates) square.push_back(columns[i]);
  auto system = IntegerSystem::prepared(square);
  if (!system) return std::nullopt;
  return RowBasis(std::move(columns), std::move(coordinates), *std::move(system));
}

std::optional<ExactVector> RowBasis::coefficients(const IntegerVector& u) const {
  IntegerVector right;
  for (std::size_t i : coordinates_) right.push_back(u[i]);
  ExactVector c = system_.solve(right);
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (dot(columns_[i], c.numerators) != c.denominator * u[i]) return std::nullopt;
  return c;
}

IntegerVector dependence_of(const ExactProblem& exact) {
  const auto others = RowBasis::of({exact.U.begin() + 1, exact.U.end()}, exact.z.size());
  const auto c = others ? others->coefficients(exact.U[0]) : std::nullopt;
  if (!c) return {};
  IntegerVector w{c->denominator};
  for (const Integer& numerator : c->numerators) w.push_back(-numerator);
  for (std::size_t a = 0; a < w.size(); ++a) w[a] *= exact.row_unit[a];
  make_primitive(w);
  return w;
}

bool are_equalities(const NearestPointProblem& problem, Index a, const std::vector<Index>& others) {
  std::vector<Index> rows{a};
  rows.insert(rows.end(), others.begin(), others.end());
  const ExactProblem exact = as_integers(restricted_rows(problem, rows));
  const IntegerVector w = dependence_of(exact);
  if (w.empty()) return false;
  Fraction left;
  for (std::size_t r = 0; r < w.size(); ++r) {
    if (w[r].sign() <= 0 && !problem.is_two_sided(rows[r])) return false;
    left = left + Fraction{w[r], 1} * Fraction{exact.s[r], exact.row_unit[r]};
  }
  return sign(left) == 0;
}

std::optional<bool> depend_as_told(const NearestPointProblem& problem, const std::vector<Index>& basic,
                                   const std::vector<Index>& dependent, const Matrix& T, double most_words) {
  using Word = ModularField::Word;
  const double K = static_cast<double>(basic.size()), d = static_cast<double>(dependent.size()),
               n = static_cast<double>(problem.dimension());
  if (K * (K * (n + 2 * K) + d * (n + K)) > most_words) return std::nullopt;
  std::vector<Index> rows = basic;
  rows.insert(rows.end(), dependent.begin(), dependent.end());
  const ExactProblem exact = as_integers(restricted_rows(problem, rows));
  const std::size_t k = basic.size(), columns = exact.z.size();
  IntegerRows of_basic(columns, IntegerVector(k));
  for (std::size_t i = 0; i < columns; ++i)
    for (std::size_t r = 0; r < k; ++r) of_basic[i][r] = exact.U[r][i];
  const std::vector<std::size_t> chosen = independent_rows(of_basic, k);
  const ModularField field(large_primes.front());
  IntegerRows square;
  for (std::size_t i : chosen) square.push_back(of_basic[i]);
  const auto inverse = chosen.size() == k ? modular_inverse(square, field) : std::nullopt;
  if (!inverse) return false;
  std::vector<Word> basic_words(columns * k), coefficients(k), right(k);
  for (std::size_t i = 0; i < columns; ++i)
    for (std::size_t r = 0; r < k; ++r) basic_words[i * k + r] = field.from(of_basic[i][r]);
  const auto dot = [&](const Word* x, const std::vector<Word>& y) {
    ModularField::Wide sum = 0;
    for (std::size_t r = 0; r < k; ++r) sum = field.accumulate(sum, x[r], y[r]);
    return field.reduce(sum);
  };
  for (std::size_t p = 0; p < dependent.size(); ++p) {
    const IntegerVector& u = exact.U[k + p];
    for (std::size_t i = 0; i < k; ++i) right[i] = field.from(u[chosen[i]]);
    for (std::size_t r = 0; r < k; ++r) {
      coefficients[r] = dot(&(*inverse)[r * k], right);
      if ((coefficients[r] == 0) != (T(static_cast<Index>(r), static_cast<Index>(p)) == 0)) return false;
    }
    for (std::size_t i = 0; i < columns; ++i)
      if (dot(&basic_words[i * k], coefficients) != field.from(u[i])) return false;
  }
  return true;
}

bool follow_exactly(const NearestPointProblem& problem, const std::vector<Index>& rows,
                    const std::vector<Index>& held, double most_words) {
  std::vector<Index> all = held;
  all.insert(all.end(), rows.begin(), rows.end());
  const std::size_t k = held.size();
  const double K = static_cast<double>(k), n = static_cast<double>(problem.dimension());
  double words = K * K * n + static_cast<double>(rows.size()) * K * n;
  if (words > most_words) return false;
  const ExactProblem exact = as_integers(restricted_rows(problem, all));
  const auto held_rows = static_cast<std::ptrdiff_t>(k);
  const auto basis = RowBasis::of({exact.U.begin(), exact.U.begin() + held_rows}, exact.z.size());
  if (!basis) return false;
  const IntegerVector bounds(exact.s.begin(), exact.s.begin() + held_rows);
  for (std::size_t p = 0; p < rows.size(); ++p) {
    // Of the integer rows: denominator u = Σ numerators_r u_r, and the bounds.
    const auto c = basis->coefficients(exact.U[k + p]);
    if (!c) return false;
    const int off = (dot(bounds, c->numerators) - c->denominator * exact.s[k + p]).sign();
    if (problem.is_two_sided(rows[p]) ? off != 0 : off < 0) return false;
    std::size_t bits = c->denominator.bits();
    for (const Integer& numerator : c->numerators) bits = std::max(bits, numerator.bits());
    words += K * K * (2 + 2 * static_cast<double>(bits) / 62) * 2;
    if (words > most_words) return false;
  }
  return true;
}

}  // namespace convex::inline proof
