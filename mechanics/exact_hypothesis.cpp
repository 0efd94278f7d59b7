#include <algorithm>
#include <numeric>

#include "convex/exact/modular.hpp"
#include "mechanics/exact_gauss_solution.hpp"

namespace mechanics {
namespace {

using convex::ExactProblem;
using convex::ExactSolution;
using convex::ExactVector;
using convex::Status;

/// The problem with only the rows `kept`, all two-sided.
ExactProblem held(const ExactProblem& problem, const std::vector<Index>& kept) {
  ExactProblem rows{problem.A, problem.z, problem.unit, {}, {}, {}, {}};
  for (Index kept_row : kept) {
    const auto a = static_cast<std::size_t>(kept_row);
    rows.two_sided.push_back(static_cast<Index>(rows.U.size()));
    rows.U.push_back(problem.U[a]);
    rows.s.push_back(problem.s[a]);
    rows.row_unit.push_back(problem.row_unit[a]);
  }
  return rows;
}

/// Whether more than n of the equations u_a·q = s_a are independent, s included: then they have no solution,
/// and that is cheap to see.
bool contradict_at_once(const ExactProblem& problem) {
  const std::size_t n = problem.z.size();
  if (problem.U.size() <= n) return false;
  convex::IntegerRows extended = problem.U;
  for (std::size_t a = 0; a < extended.size(); ++a) extended[a].push_back(problem.s[a]);
  return convex::independent_rows(extended, n + 1).size() > n;
}

ExactSolution solve_held(const ExactProblem& problem, double most_words) {
  ExactSolution none;
  none.status = Status::infeasible;
  return contradict_at_once(problem) ? none
                                     : convex::exact_active_set(problem, problem.two_sided, most_words);
}

bool same(const ExactVector& x, const ExactVector& y) {
  for (std::size_t i = 0; i < x.numerators.size(); ++i)
    if (!(convex::Fraction{x.numerators[i], x.denominator} ==
          convex::Fraction{y.numerators[i], y.denominator}))
      return false;
  return true;
}

}  // namespace

std::optional<Hypothesis> exact_hypothesis(const ExactProblem& problem, const ExactSolution& truth,
                                           double most_words) {
  Hypothesis found;
  std::vector<Index> all(problem.s.size());
  std::iota(all.begin(), all.end(), Index{0});
  if (truth.basis.size() == all.size()) {
    found.two_sided = {true, convex::nearest(truth.q), convex::nearest(truth.lambda), true, false};
    found.accepted = true;
    return found;
  }
  const ExactProblem classical = held(problem, all);
  const ExactSolution solution = solve_held(classical, most_words);
  if (solution.status == Status::infeasible) return found;
  if (solution.status == Status::gave_up) return std::nullopt;
  const std::optional<convex::ExactMultipliers> multipliers =
      convex::exact_multipliers(classical, solution, false, most_words);
  if (!multipliers) return std::nullopt;
  const convex::ExactMultipliers& set = *multipliers;
  found.two_sided = {true, convex::nearest(solution.q), convex::nearest(set.least_norm), set.unique};
  // Some two-sided multipliers are >= 0 if and only if the two-sided motion is the true one.
  found.accepted = same(solution.q, truth.q);
  std::vector<Index> kept;
  for (Index a : all) {
    const bool is_two_sided = std::binary_search(problem.two_sided.begin(), problem.two_sided.end(), a);
    const bool negative = !is_two_sided && set.least_norm.numerators[static_cast<std::size_t>(a)].sign() < 0;
    (negative ? found.negative : kept).push_back(a);
  }
  if (found.accepted || !set.unique) return found;
  const ExactSolution dropped = solve_held(held(problem, kept), most_words);
  if (dropped.status == Status::gave_up) return std::nullopt;
  const bool consistent = dropped.status != Status::infeasible;
  if (consistent) found.drop_negative_acceleration = convex::nearest(dropped.q);
  found.drop_negative_is_right = consistent && same(dropped.q, truth.q);
  return found;
}

}  // namespace mechanics
