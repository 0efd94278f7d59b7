#include "convex/nearest_point/multipliers/sparse_multipliers.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/isotonic/peeling.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/sparse/held_firmly.hpp"
#include "convex/nearest_point/sparse/sparse_active_set.hpp"

namespace convex::inline multiplier_sets {

bool sparse_rows_are_independent(const NearestPointProblem& problem, const std::vector<Index>& rows) {
  const std::vector<Index> core = rows_left_by_peeling(problem.U, rows);
  if (core.empty()) return true;
  if (static_cast<Index>(core.size()) > problem.dimension()) return false;
  const NearestPointProblem part{Metric::identity(problem.dimension()),
                                 Vector::Zero(problem.dimension()),
                                 problem.U.select(core),
                                 Vector::Zero(static_cast<Index>(core.size())),
                                 {}};
  const BalancedProblem balanced = balanced_problem(part);
  RowSystem system(balanced);
  constexpr double weight_of_rows = 2e9;
  const Vector weight = Vector::Constant(part.rows(), weight_of_rows);
  return system.factor(weight) &&
         is_held_firmly(slowest_residual(balanced, system, indices_below(part.rows()), weight));
}

bool can_open(const NearestPointProblem& problem, const std::vector<Index>& held,
              const std::vector<Index>& opening) {
  if (opening.empty()) return true;
  std::vector<Index> rows = held;
  rows.insert(rows.end(), opening.begin(), opening.end());
  Vector s = Vector::Zero(static_cast<Index>(rows.size()));
  s.tail(static_cast<Index>(opening.size())) = dual_lengths(problem, opening)(opening);
  std::optional<DataRadii> radii = select(problem.radii, rows);
  if (radii) radii->s.setZero();
  const Solution found =
      automatic({problem.A, Vector::Zero(problem.dimension()), problem.U.select(rows), std::move(s),
                 indices_below(static_cast<Index>(held.size())), std::move(radii)},
                {});
  return found.status == Status::solved || found.status == Status::inaccurate;
}

bool least_norm_multipliers(const NearestPointProblem& problem, const std::vector<Index>& tight,
                            Vector& lambda) {
  const Index k = static_cast<Index>(tight.size()), n = problem.dimension();
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<Index> signed_rows;
  for (Index j = 0; j < k; ++j) {
    const Index a = tight[at(j)];
    problem.U.for_each_entry(a, [&](Index i, double value) {
      entries.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
    });
    if (!problem.is_two_sided(a)) signed_rows.push_back(j);
  }
  const Index m = n + static_cast<Index>(signed_rows.size());
  Vector start(k), s = Vector::Zero(m);
  for (Index j = 0; j < k; ++j) start[j] = lambda[tight[at(j)]];
  if (!start.allFinite()) return false;  // a multiplier is beyond doubles
  for (std::size_t j = 0; j < signed_rows.size(); ++j) {
    entries.emplace_back(static_cast<int>(n) + static_cast<int>(j), static_cast<int>(signed_rows[j]), 1.0);
    s[n + static_cast<Index>(j)] = -start[signed_rows[j]];
  }
  SparseRows U(m, k);
  U.setFromTriplets(entries.begin(), entries.end());
  const Solution found = sparse_active_set(
      {Metric::identity(k), -start, ConstraintRows(std::move(U)), s, indices_below(n)}, {.limit = 0});
  if (found.status != Status::solved) return false;
  const double noise = 16 * unit_roundoff * start.cwiseAbs().maxCoeff();
  for (Index j = 0; j < k; ++j) {
    const double best = start[j] + found.q[j];
    lambda[tight[at(j)]] = std::abs(best) <= noise ? 0 : best;
  }
  for (Index j : signed_rows) {
    double& value = lambda[tight[at(j)]];
    value = std::max(0.0, value);
  }
  return true;
}

}  // namespace convex::inline multiplier_sets
