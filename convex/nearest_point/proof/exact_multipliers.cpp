#include "convex/nearest_point/proof/exact_multipliers.hpp"

#include <algorithm>
#include <limits>

#include "convex/exact/modular.hpp"
#include "convex/infinity.hpp"
#include "convex/nearest_point/proof/exact_least_norm.hpp"

namespace convex::inline proof {
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

/// e_p - Σ T_kp e_k.
std::vector<std::pair<Index, Fraction>> null_vector(const std::vector<Index>& basic, const ExactVector& T,
                                                    Index p) {
  std::vector<std::pair<Index, Fraction>> mu{{p, {1, 1}}};
  for (std::size_t k = 0; k < basic.size(); ++k)
    if (!T.numerators[k].is_zero()) mu.emplace_back(basic[k], -entry(T, k));
  std::sort(mu.begin(), mu.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return mu;
}

std::vector<std::vector<Fraction>> columns(const std::vector<ExactVector>& T) {
  std::vector<std::vector<Fraction>> found(T.size());
  for (std::size_t j = 0; j < T.size(); ++j)
    for (std::size_t k = 0; k < T[j].numerators.size(); ++k) found[j].push_back(entry(T[j], k));
  return found;
}

}  // namespace

ExactMultipliers exact_multipliers(const ExactProblem& problem, const ExactSolution& solution,
                                   bool want_ranges) {
  return *exact_multipliers(problem, solution, want_ranges, std::numeric_limits<double>::infinity());
}

double words_of_ranges(std::size_t multipliers, std::size_t dependent) {
  const double all = static_cast<double>(multipliers), d = static_cast<double>(dependent);
  return 2 * all * (all - d) * d * words_of_fraction;
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
    const std::vector<ExactVector> T = exact_expansions(problem, basic, dependent);
    for (std::size_t p = 0; p < dependent.size(); ++p)
      found.null_space.push_back(null_vector(basic, T[p], dependent[p]));
    std::vector<Fraction> value;
    for (Index a : basic) value.push_back(entry(solution.lambda, at(a)));
    MultiplierTableau<Fraction> all(basic, value, dependent, columns(T), is_free);
    all.allow(left + of_ranges);
    // They are unique when every dependent row keeps its multiplier 0.
    for (Index p : dependent) {
      ranges[at(p)] = all.range(p);
      const ExactInterval& range = ranges[at(p)];
      if (!range.low || !range.high || !(*range.low == *range.high)) found.unique = false;
      if (!found.unique && !want_ranges) break;
    }
    if (!found.unique) {
      if (!exact_least_norm(problem, basic, dependent, is_free, left, found.least_norm)) return std::nullopt;
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

}  // namespace convex::inline proof
