#include "convex/exact_program/linear_equations.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "convex/exact/integer_system.hpp"
#include "convex/vector.hpp"

namespace convex::inline exact_programs {
namespace {

/// Full systems from this size on are lifted modulo a prime (Dixon 1982).
constexpr std::size_t least_lifted = 24;

/// Of an equation those unknowns may be eliminated whose coefficients are at least such a part of its
/// largest: through a coefficient that all but cancelled a free unknown moves the others far from their guess
/// (threshold pivoting: Duff, Erisman, Reid 1986).
constexpr double part_of_largest = 0.1;

std::size_t nonzeros(const std::vector<ExactEquation>& equations) {
  return std::accumulate(
      equations.begin(), equations.end(), std::size_t{0},
      [](std::size_t sum, const ExactEquation& equation) { return sum + equation.row.size(); });
}

/// The unique solution of a square system; none when it is singular.
std::optional<Fractions> lifted(const std::vector<ExactEquation>& equations, std::size_t n) {
  IntegerRows M;
  IntegerVector right;
  for (const ExactEquation& equation : equations) {
    Fractions entries(n + 1);
    for (const auto& [j, value] : equation.row) entries[j] = value;
    entries[n] = equation.right;
    ExactVector row = exact_vector(entries);
    right.push_back(row.numerators.back());
    row.numerators.pop_back();
    M.push_back(std::move(row.numerators));
  }
  const auto system = IntegerSystem::prepared(M);
  if (!system) return std::nullopt;
  const ExactVector solution = system->solve(right);
  Fractions u(n);
  for (std::size_t i = 0; i < n; ++i) u[i] = entry(solution, i);
  return u;
}

/// A column for each row, in which elimination in doubles finds its largest entry; fewer where a row is left
/// with nothing.
std::vector<std::size_t> pivot_columns(Matrix M) {
  std::vector<std::size_t> columns;
  for (Index i = 0; i < M.rows(); ++i) {
    Index pivot = 0;
    const double size = M.row(i).cwiseAbs().maxCoeff(&pivot);
    if (!(size > 0) || !std::isfinite(size)) return {};
    columns.push_back(static_cast<std::size_t>(pivot));
    const Index below = M.rows() - i - 1;
    const Vector factors = M.col(pivot).tail(below) / M(i, pivot);
    M.bottomRows(below).noalias() -= factors * M.row(i);
    M.col(pivot).tail(below).setZero();
  }
  return columns;
}

class Elimination {
 public:
  Elimination(std::vector<ExactEquation> equations, std::size_t n)
      : equations_(std::move(equations)), in_rows_(n), waiting_(equations_.size()) {
    for (std::size_t a = 0; a < equations_.size(); ++a) {
      waiting_[a] = a;
      for (const auto& [j, value] : equations_[a].row) in_rows_[j].insert(a);
    }
  }

  /// False when an equation reads 0 = something else.
  bool run(const Fractions& guess) {
    while (!waiting_.empty()) {
      const auto shortest = std::min_element(waiting_.begin(), waiting_.end(), [&](auto a, auto b) {
        return equations_[a].row.size() < equations_[b].row.size();
      });
      if (equations_[*shortest].row.size() >= least_lifted && !tried_to_lift_ && lift_rest(guess))
        return true;
      const std::size_t a = *shortest;
      waiting_.erase(shortest);
      const ExactEquation& chosen = equations_[a];
      if (chosen.row.empty()) {
        if (sign(chosen.right) != 0) return false;
        continue;
      }
      const std::size_t pivot = rarest(chosen.row);
      for (const auto& [j, value] : chosen.row) in_rows_[j].erase(a);
      const std::set<std::size_t> others = in_rows_[pivot];
      for (std::size_t b : others) subtract(chosen, pivot, b);
      solved_.emplace_back(pivot, a);
    }
    return true;
  }

  Fractions back_substituted(Fractions u) const {
    for (const auto& [j, value] : lifted_) u[j] = value;
    for (auto step = solved_.rbegin(); step != solved_.rend(); ++step) {
      const auto& [pivot, a] = *step;
      const ExactEquation& equation = equations_[a];
      u[pivot] = {};
      u[pivot] = (equation.right - dot(equation.row, u)) / equation.row.at(pivot);
    }
    return u;
  }

 private:
  /// Solves what is left as one full system, where it is regular in unknowns that doubles choose; the others
  /// keep their guess.
  bool lift_rest(const Fractions& guess) {
    tried_to_lift_ = true;
    std::vector<std::size_t> unknowns;
    for (std::size_t j = 0; j < in_rows_.size(); ++j)
      if (!in_rows_[j].empty()) unknowns.push_back(j);
    const std::size_t m = waiting_.size();
    if (unknowns.size() < m) return false;
    Matrix M = Matrix::Zero(static_cast<Index>(m), static_cast<Index>(unknowns.size()));
    std::vector<std::size_t> place(in_rows_.size());
    for (std::size_t k = 0; k < unknowns.size(); ++k) place[unknowns[k]] = k;
    for (std::size_t i = 0; i < m; ++i)
      for (const auto& [j, value] : equations_[waiting_[i]].row)
        M(static_cast<Index>(i), static_cast<Index>(place[j])) = nearest_double(value);
    const std::vector<std::size_t> chosen = pivot_columns(std::move(M));
    if (chosen.size() != m) return false;
    constexpr std::size_t not_chosen = static_cast<std::size_t>(-1);
    place.assign(in_rows_.size(), not_chosen);
    for (std::size_t k = 0; k < m; ++k) place[unknowns[chosen[k]]] = k;
    std::vector<ExactEquation> rest;
    for (const std::size_t a : waiting_) {
      rest.push_back({{}, equations_[a].right});
      for (const auto& [j, value] : equations_[a].row) {
        if (place[j] == not_chosen)
          rest.back().right = rest.back().right - value * guess[j];
        else
          rest.back().row[place[j]] = value;
      }
    }
    const auto solution = lifted(rest, m);
    if (!solution) return false;
    for (std::size_t k = 0; k < m; ++k) lifted_.emplace_back(unknowns[chosen[k]], (*solution)[k]);
    waiting_.clear();
    return true;
  }

  /// Of the unknowns with a coefficient of size the one in the fewest equations.
  std::size_t rarest(const ExactRow& row) const {
    std::vector<double> sizes;
    for (const auto& [j, value] : row) sizes.push_back(std::abs(nearest_double(value)));
    const double least = part_of_largest * *std::max_element(sizes.begin(), sizes.end());
    std::size_t best = row.begin()->first, fewest = static_cast<std::size_t>(-1), k = 0;
    for (const auto& [j, value] : row)
      if (sizes[k++] >= least && in_rows_[j].size() < fewest) {
        best = j;
        fewest = in_rows_[j].size();
      }
    return best;
  }

  void subtract(const ExactEquation& chosen, std::size_t pivot, std::size_t b) {
    ExactEquation& other = equations_[b];
    const Fraction factor = -(other.row.at(pivot) / chosen.row.at(pivot));
    for (const auto& [j, value] : chosen.row) {
      add(other.row, j, value * factor);
      if (other.row.contains(j))
        in_rows_[j].insert(b);
      else
        in_rows_[j].erase(b);
    }
    other.right = other.right + chosen.right * factor;
  }

  std::vector<ExactEquation> equations_;
  std::vector<std::set<std::size_t>> in_rows_;  ///< of an unknown: the waiting equations that have it
  std::vector<std::size_t> waiting_;
  std::vector<std::pair<std::size_t, std::size_t>> solved_;  ///< unknown, equation
  std::vector<std::pair<std::size_t, Fraction>> lifted_;     ///< unknowns of the full system that was left
  bool tried_to_lift_ = false;
};

}  // namespace

std::optional<Fractions> solve_near(std::vector<ExactEquation> equations, const Fractions& guess) {
  const std::size_t n = guess.size();
  if (equations.size() == n && n >= least_lifted && 4 * nonzeros(equations) > n * n)
    if (auto u = lifted(equations, n)) return u;
  Elimination elimination(std::move(equations), n);
  if (!elimination.run(guess)) return std::nullopt;
  return elimination.back_substituted(guess);
}

}  // namespace convex::inline exact_programs
