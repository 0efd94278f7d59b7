#include "convex/nearest_point/multipliers/exact_multipliers.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "convex/exact/elimination.hpp"
#include "convex/exact/integer_system.hpp"
#include "convex/exact/modular.hpp"
#include "convex/infinity.hpp"
#include "convex/invariant.hpp"
#include "convex/nearest_point/proof/exact_dependence.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "convex/nearest_point/proof/exact_solution.hpp"

namespace convex::inline multiplier_sets {
namespace {

/// Of the expansions of d rows in k: each is the solution of a linear system, of d and n unknowns at most.
double words_of_expansions(const ExactProblem& problem, std::size_t k, std::size_t d) {
  return static_cast<double>(d + 1) * word_operations(problem, k) / 8;
}

/// The basis and those of the other tight rows that make it span them all.
std::vector<Index> spanning(const ExactProblem& problem, std::vector<Index> basis,
                            const std::vector<Index>& tight) {
  IntegerRows rows;
  std::vector<Index> order = basis;
  for (Index a : tight)
    if (std::find(basis.begin(), basis.end(), a) == basis.end()) order.push_back(a);
  for (Index a : order) rows.push_back(problem.U[at(a)]);
  std::vector<Index> chosen;
  for (std::size_t k : independent_rows(rows, problem.z.size())) chosen.push_back(order[k]);
  return chosen;
}

/// The coefficients of rows in the basis, on which they depend: u_p = Σ T_kp u_k. One vector a row.
std::vector<ExactVector> expansions(const ExactProblem& problem, const RowBasis& basis,
                                    const std::vector<Index>& basic, const std::vector<Index>& rows) {
  std::vector<ExactVector> all;
  for (Index p : rows) {
    const auto c = basis.coefficients(problem.U[at(p)]);
    invariant(c.has_value(), "a row depends on rows that span it modulo a large prime");
    std::vector<Fraction> of_row;
    for (std::size_t k = 0; k < basic.size(); ++k)
      of_row.push_back(lowest_terms(
          {c->numerators[k] * problem.row_unit[at(basic[k])], c->denominator * problem.row_unit[at(p)]}));
    all.push_back(exact_vector(of_row));
  }
  return all;
}

/// e_p - Σ T_kp e_k.
std::vector<std::pair<Index, Fraction>> null_vector(const std::vector<Index>& basic, const ExactVector& T,
                                                    Index p) {
  std::vector<std::pair<Index, Fraction>> mu{{p, {1, 1}}};
  for (std::size_t k = 0; k < basic.size(); ++k)
    if (!T.numerators[k].is_zero()) mu.emplace_back(basic[k], -entry(T, k));
  std::sort(mu.begin(), mu.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return mu;
}

/// The unit in which row a is primitive, the common divisor of its entries; 1 where all are 0. However far
/// apart the units of rows are told, their tableau in these is the same.
Fraction primitive_unit(const ExactProblem& problem, Index a) {
  Integer divisor;
  for (const Integer& entry : problem.U[at(a)]) divisor = greatest_common_divisor(divisor, entry);
  if (divisor.is_zero()) return {1, 1};
  return lowest_terms({std::move(divisor), problem.row_unit[at(a)]});
}

/// The tableau of rows, at lambda. Its numbers are multipliers times the unit of their row and the
/// denominator of lambda.
class ExactPolyhedron {
 public:
  /// T: coefficients of the dependent rows in the basic ones.
  ExactPolyhedron(const ExactProblem& problem, const ExactVector& lambda, const std::vector<Index>& basic,
                  const std::vector<Index>& dependent, const std::vector<ExactVector>& T,
                  const std::vector<bool>& is_free)
      : unit_(problem.U.size()), denominator_(lambda.denominator) {
    for (const auto* rows : {&basic, &dependent})
      for (const Index a : *rows) unit_[at(a)] = primitive_unit(problem, a);
    std::vector<Fraction> all;  // the values, then T by columns
    for (const Index a : basic) all.push_back(Fraction{lambda.numerators[at(a)], 1} * unit_[at(a)]);
    for (std::size_t p = 0; p < dependent.size(); ++p)
      for (std::size_t k = 0; k < basic.size(); ++k)
        all.push_back(entry(T[p], k) * unit_[at(basic[k])] / unit_[at(dependent[p])]);
    ExactVector numbers = exact_vector(all);
    auto column = [&, next = numbers.numerators.begin()]() mutable {
      const auto begin = next;
      next += static_cast<std::ptrdiff_t>(basic.size());
      return IntegerVector(begin, next);
    };
    IntegerVector value = column();
    std::vector<IntegerVector> columns(dependent.size());
    for (IntegerVector& of_row : columns) of_row = column();
    tableau_.emplace(basic, std::move(value), dependent, std::move(columns), is_free,
                     std::move(numbers.denominator));
  }

  void allow(double words) { tableau_->allow(words); }
  bool is_spent() const { return tableau_->is_spent(); }
  ExactInterval range(Index a) {
    ExactInterval range = tableau_->range(a);
    for (std::optional<Fraction>* end : {&range.low, &range.high})
      if (*end) *end = **end / (Fraction{denominator_, 1} * unit_[at(a)]);
    return range;
  }

 private:
  std::vector<Fraction> unit_;
  Integer denominator_;
  std::optional<MultiplierTableau<Integer>> tableau_;
};

/// The shortest lambda with Σ lambda_a u_a = r, the reaction, and lambda_a >= 0 on one-sided rows. By the
/// conditions of Karush, Kuhn and Tucker lambda = (U w)⁺, the ⁺ on one-sided rows. With the rows known that
/// have a multiplier, w solves their Gram matrix in the coordinates, whose integers are short and few.
class LeastNorm {
 public:
  /// names: the rows that may have a multiplier. `lambda`: multipliers with the reaction.
  LeastNorm(const ExactProblem& problem, const std::vector<Index>& names,
            const std::vector<std::size_t>& columns, const std::vector<bool>& is_free,
            const ExactVector& lambda)
      : reaction_(columns.size()), denominator_(lambda.denominator) {
    for (const Index a : names) {
      const Integer& unit = problem.row_unit[at(a)];
      unit_ = exact_quotient(unit_ * unit, greatest_common_divisor(unit_, unit));
      is_free_.push_back(is_free[at(a)]);
    }
    for (const Index a : names) {
      const Integer factor = exact_quotient(unit_, problem.row_unit[at(a)]);
      IntegerVector& row = rows_.emplace_back();
      for (const std::size_t i : columns) {
        row.push_back(problem.U[at(a)][i] * factor);
        reaction_[row.size() - 1] += lambda.numerators[at(a)] * row.back();
      }
    }
  }

  /// The multipliers from w, where doubles know the rows that have one but for a few turns; else none, or
  /// where it takes more word operations.
  std::optional<std::vector<Fraction>> by_point(double most_words) const {
    constexpr int most_turns = 8;
    std::vector<bool> loaded = likely_loaded();
    for (int turn = 0; turn < most_turns; ++turn) {
      const ExactProblem system = gram(loaded);
      most_words -= word_operations(system, 0);
      if (!(most_words > 0)) return std::nullopt;
      const std::optional<IntegerSystem> factor = IntegerSystem::prepared(system.A);
      if (!factor) return std::nullopt;
      const ExactVector w = factor->solve(reaction_);
      bool is_right = true;
      std::vector<Fraction> lambda(rows_.size());
      for (std::size_t j = 0; j < rows_.size(); ++j) {
        const Integer along = dot(rows_[j], w.numerators);
        if (loaded[j]) lambda[j] = lowest_terms({along, w.denominator * denominator_});
        if (is_free_[j] || along.is_zero() || (along.sign() > 0) == loaded[j]) continue;
        loaded[j] = !loaded[j];
        is_right = false;
      }
      if (is_right) return lambda;
    }
    return std::nullopt;
  }

  /// As the nearest point to 0 among the multipliers. None where it takes more word operations.
  std::optional<std::vector<Fraction>> by_multipliers(double most_words) const {
    const std::size_t count = rows_.size();
    ExactProblem problem{{}, IntegerVector(count), 1, {}, {}, {}, {}};
    const auto add = [&](IntegerVector row, const Integer& bound) {
      problem.U.push_back(std::move(row));
      problem.s.push_back(bound);
      problem.row_unit.emplace_back(1);
    };
    for (std::size_t i = 0; i < reaction_.size(); ++i) {
      IntegerVector equation;
      for (const IntegerVector& row : rows_) equation.push_back(row[i]);
      add(std::move(equation), reaction_[i]);
      problem.two_sided.push_back(static_cast<Index>(i));
    }
    for (std::size_t j = 0; j < count; ++j) {
      IntegerVector unit(count);
      unit[j] = 1;
      problem.A.push_back(unit);
      if (!is_free_[j]) add(std::move(unit), 0);
    }
    const ExactSolution best = exact_active_set(problem, problem.two_sided, most_words);
    if (best.status != Status::solved) return std::nullopt;
    std::vector<Fraction> lambda;
    for (const Integer& numerator : best.q.numerators)
      lambda.push_back(lowest_terms({numerator, best.q.denominator * denominator_}));
    return lambda;
  }

 private:
  /// By doubles, all but those whose sign is held; all where these cannot hold the numbers.
  std::vector<bool> likely_loaded() const {
    const auto m = static_cast<Index>(rows_.size()), r = static_cast<Index>(reaction_.size());
    RowMatrix U = RowMatrix::Zero(r + m, m);
    Vector s = Vector::Zero(r + m);
    std::vector<Index> equations, of_row;
    for (Index i = 0; i < r; ++i) {
      for (Index j = 0; j < m; ++j) U(i, j) = nearest_quotient(rows_[at(j)][at(i)], unit_);
      s[i] = nearest_quotient(reaction_[at(i)], unit_ * denominator_);
      equations.push_back(i);
    }
    for (Index j = 0; j < m; ++j) {
      if (is_free_[at(j)]) continue;
      U(r + static_cast<Index>(of_row.size()), j) = 1;
      of_row.push_back(j);
    }
    const Index count = r + static_cast<Index>(of_row.size());
    std::vector<bool> loaded(rows_.size(), true);
    if (!U.allFinite() || !s.allFinite()) return loaded;
    const NearestPointProblem problem{Metric::identity(m), Vector::Zero(m),
                                      ConstraintRows(RowMatrix(U.topRows(count))), s.head(count),
                                      std::move(equations)};
    for (const Index row : likely_active_rows(problem))
      if (row >= r) loaded[at(of_row[at(row - r)])] = false;
    return loaded;
  }

  ExactProblem gram(const std::vector<bool>& loaded) const {
    const std::size_t r = reaction_.size();
    ExactProblem system{IntegerRows(r, IntegerVector(r)), reaction_, 1, {}, {}, {}, {}};
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      if (!loaded[j]) continue;
      for (std::size_t i = 0; i < r; ++i) {
        if (rows_[j][i].is_zero()) continue;
        for (std::size_t l = 0; l <= i; ++l) system.A[i][l] += rows_[j][i] * rows_[j][l];
      }
    }
    for (std::size_t i = 0; i < r; ++i)
      for (std::size_t l = 0; l < i; ++l) system.A[l][i] = system.A[i][l];
    return system;
  }

  std::vector<bool> is_free_;
  Integer unit_ = 1;        ///< of all rows
  IntegerRows rows_;        ///< times the unit, in the independent columns
  IntegerVector reaction_;  ///< times unit and denominator
  Integer denominator_;
};

/// The shortest multipliers of the same reaction as `lambda`, which is changed into them: >= 0 where not
/// `is_free`, 0 but on the rows `basic`, which are independent, also in `coordinates` alone, and `dependent`,
/// which depend on them.
/// lambda, is_free: m. False, and nothing is changed, where that takes more word operations.
bool exact_least_norm(const ExactProblem& problem, const std::vector<std::size_t>& coordinates,
                      const std::vector<Index>& basic, const std::vector<Index>& dependent,
                      const std::vector<bool>& is_free, double most_words, ExactVector& lambda) {
  std::vector<Index> names = basic;
  names.insert(names.end(), dependent.begin(), dependent.end());
  const LeastNorm shortest(problem, names, coordinates, is_free, lambda);
  std::optional<std::vector<Fraction>> best = shortest.by_point(most_words);
  if (!best) best = shortest.by_multipliers(most_words);
  if (!best) return false;
  std::vector<Fraction> all(lambda.numerators.size());
  for (std::size_t j = 0; j < names.size(); ++j) all[at(names[j])] = (*best)[j];
  lambda = exact_vector(all);
  return true;
}

}  // namespace

ExactMultipliers exact_multipliers(const ExactProblem& problem, const ExactSolution& solution,
                                   bool want_ranges) {
  return *exact_multipliers(problem, solution, want_ranges, std::numeric_limits<double>::infinity());
}

double words_of_ranges(std::size_t multipliers, std::size_t dependent) {
  const double all = static_cast<double>(multipliers), d = static_cast<double>(dependent);
  return 2 * all * (all - d) * d * words_of_entry;
}

std::optional<ExactMultipliers> exact_multipliers(const ExactProblem& problem, const ExactSolution& solution,
                                                  bool want_ranges, double most_words) {
  ExactMultipliers found;
  found.least_norm = solution.lambda;
  const std::vector<bool> is_free = marked(problem.rows(), problem.two_sided);
  for (Index a = 0; a < problem.rows(); ++a)
    if (sign(solution.slack[at(a)]) == 0) found.tight.push_back(a);
  const std::vector<Index> basic = spanning(problem, solution.basis, found.tight);
  const std::vector<bool> held = marked(problem.rows(), basic);
  std::vector<Index> dependent;
  for (Index a : found.tight)
    if (!held[at(a)]) dependent.push_back(a);
  std::vector<ExactInterval> ranges;
  for (std::size_t a = 0; a < problem.s.size(); ++a) {
    const Fraction value = entry(solution.lambda, a);
    ranges.push_back({value, value});
  }
  if (!dependent.empty()) {
    const double of_ranges = want_ranges ? words_of_ranges(found.tight.size(), dependent.size()) : 0,
                 left = most_words - of_ranges - words_of_expansions(problem, basic.size(), dependent.size());
    if (!(left > 0)) return std::nullopt;
    IntegerRows rows;
    for (Index a : basic) rows.push_back(problem.U[at(a)]);
    const auto basis = RowBasis::of(rows, problem.z.size());
    invariant(basis.has_value(), "rows independent modulo a large prime are so modulo others");
    const std::vector<ExactVector> T = expansions(problem, *basis, basic, dependent);
    for (std::size_t p = 0; p < dependent.size(); ++p)
      found.null_space.push_back(null_vector(basic, T[p], dependent[p]));
    ExactPolyhedron all(problem, solution.lambda, basic, dependent, T, is_free);
    all.allow(left + of_ranges);
    // They are unique when every dependent row keeps its multiplier 0.
    for (Index p : dependent) {
      ranges[at(p)] = all.range(p);
      const ExactInterval& range = ranges[at(p)];
      if (!range.low || !range.high || !(*range.low == *range.high)) found.unique = false;
      if (!found.unique && !want_ranges) break;
    }
    if (!found.unique) {
      if (!exact_least_norm(problem, basis->coordinates(), basic, dependent, is_free, left, found.least_norm))
        return std::nullopt;
      if (want_ranges)
        for (Index a : basic) ranges[at(a)] = all.range(a);
    }
    if (all.is_spent()) return std::nullopt;
  }
  if (want_ranges || found.unique) found.ranges = std::move(ranges);
  return found;
}

Multipliers rounded(const ExactMultipliers& exact) {
  Multipliers found;
  found.unique = exact.unique;
  found.least_norm = nearest(exact.least_norm);
  found.tight = exact.tight;
  found.null_space.emplace();
  for (const auto& exact_mu : exact.null_space) {
    NullVector& mu = found.null_space->emplace_back();
    for (const auto& [row, coefficient] : exact_mu) mu.emplace_back(row, nearest_double(coefficient));
  }
  if (exact.ranges) {
    found.ranges.emplace();
    for (const ExactInterval& range : *exact.ranges)
      found.ranges->push_back({range.low ? nearest_double(*range.low) : -infinity,
                               range.high ? nearest_double(*range.high) : infinity});
  }
  return found;
}

}  // namespace convex::inline multiplier_sets
