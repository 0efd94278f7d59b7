#include "mechanics/hypothesis.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/zero_tolerances.hpp"

namespace mechanics {
namespace {

using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;

bool has_answer(const Solution& solution) {
  return solution.status == Status::solved || solution.status == Status::inaccurate;
}

/// The problem with only the rows `kept`, all two-sided.
NearestPointProblem held(const NearestPointProblem& problem, const std::vector<Index>& kept) {
  NearestPointProblem rows{problem.A,
                           problem.z,
                           problem.U.select(kept),
                           Vector(static_cast<Index>(kept.size())),
                           {},
                           convex::select(problem.radii, kept)};
  for (std::size_t k = 0; k < kept.size(); ++k) rows.s[static_cast<Index>(k)] = problem.s[kept[k]];
  rows.two_sided.resize(kept.size());
  std::iota(rows.two_sided.begin(), rows.two_sided.end(), Index{0});
  return rows;
}

std::vector<Index> all_rows(const NearestPointProblem& problem) {
  std::vector<Index> all(static_cast<std::size_t>(problem.rows()));
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

/// From this size on sparse factors are used where the data allow it. Contradictions, of which nobody asks
/// for the weights, and what else doubles can tell cost no fractions.
Solution held_solution(const NearestPointProblem& problem, double limit = 1) {
  constexpr Index large = 200;
  const auto solve = [&](const convex::Accuracy& accuracy) {
    return problem.dimension() >= large ? convex::automatic(problem, accuracy)
                                        : convex::active_set(problem, accuracy);
  };
  convex::Accuracy in_doubles;
  in_doubles.limit = 0;
  Solution found = solve(in_doubles);
  const bool ended = found.status == Status::solved || found.status == Status::infeasible;
  return ended || !(limit > 0) ? found : solve({.limit = limit});
}

}  // namespace

convex::Solution two_sided_motion(const NearestPointProblem& problem) {
  return held_solution(held(problem, all_rows(problem)));
}

Hypothesis hypothesis(const NearestPointProblem& problem, const Solution& truth, double tolerance,
                      double limit) {
  Hypothesis found;
  const double scale = std::max(truth.acceleration_norm, truth.force_norm);
  // At rest the scale is a rounding itself: what the bound of an answer leaves open is no difference either.
  const double open = truth.status == Status::solved ? truth.error_bound : 0;
  const auto same = [&](const Vector& acceleration) {
    return problem.A.norm(acceleration - truth.q) <= std::max(tolerance * scale, open);
  };
  const std::vector<Index> all = all_rows(problem);
  // Every contact persists and all are independent: the two-sided motion is the true one.
  const bool all_persist = truth.basis.size() == all.size();
  const auto read_off = [&] {
    found.two_sided = {true, truth.q, truth.lambda, true, false};
    found.accepted = true;
    return found;
  };
  if (all_persist && problem.rows() > most_contacts_from_dual) return read_off();
  const NearestPointProblem classical = held(problem, all);
  const Solution solution = held_solution(classical, limit);
  if (!has_answer(solution)) return all_persist ? read_off() : found;
  if (all_persist && same(solution.q)) {
    found.two_sided = {true, solution.q, solution.lambda, true};
    found.accepted = true;
    return found;
  }

  // A contact that opens, however little beside the largest force, does not persist.
  std::vector<bool> opens(all.size(), true);
  for (const Index a : convex::tight_rows(problem, truth, tolerance))
    opens[static_cast<std::size_t>(a)] = false;
  const auto persist = [&](const std::vector<Index>& rows) {
    return std::none_of(rows.begin(), rows.end(),
                        [&](Index a) { return opens[static_cast<std::size_t>(a)]; });
  };
  const convex::Multipliers set = convex::multipliers(classical, solution, tolerance, false);
  found.two_sided = {true, solution.q, set.least_norm, set.unique, true, set.is_in_doubt};
  // Some two-sided multipliers are >= 0 if and only if the two-sided motion is the true one: (2), (7)-(9)
  // then hold.
  found.accepted = same(solution.q) && persist(all);

  const Vector length = convex::dual_lengths(problem, all);
  const std::vector<bool> two_sided = convex::marked(problem.rows(), problem.two_sided);
  const double push = std::max(
      scale, set.least_norm.size() > 0 ? set.least_norm.cwiseAbs().cwiseProduct(length).maxCoeff() : 0.0);
  // Below 0 by more than its rounding, however little beside the largest force.
  const double zero = problem.radii ? convex::zero_where_z_is_rounded : convex::zero_in_doubles;
  const double least =
      set.unique ? std::min(tolerance * push, solution.error_bound + zero * push) : tolerance * push;
  const auto below = [&](double zero_push) {
    std::vector<Index> rows;
    for (Index a : all)
      if (!two_sided[static_cast<std::size_t>(a)] && set.least_norm[a] * length[a] < -zero_push)
        rows.push_back(a);
    return rows;
  };
  found.negative = below(least);
  // Where a contact opens some multiplier is below 0, of whatever size: that of one which opens.
  if (found.negative.empty() && set.unique && !persist(all)) {
    found.negative = below(0);
    std::erase_if(found.negative, [&](Index a) { return !opens[static_cast<std::size_t>(a)]; });
  }
  std::vector<Index> kept;
  std::set_difference(all.begin(), all.end(), found.negative.begin(), found.negative.end(),
                      std::back_inserter(kept));
  // Accelerations that are the same within the tolerance may be those of other forces.
  if (set.unique && !found.negative.empty()) found.accepted = false;
  if (found.accepted || !set.unique) return found;
  const Solution dropped = held_solution(held(problem, kept), limit);
  if (has_answer(dropped)) found.drop_negative_acceleration = dropped.q;
  // What is not solved is no truth to judge the rule by.
  if (truth.status == convex::Status::solved)
    found.drop_negative_is_right = has_answer(dropped) && same(dropped.q) && persist(kept);
  return found;
}

}  // namespace mechanics
