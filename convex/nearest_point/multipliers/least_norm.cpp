#include "convex/nearest_point/multipliers/least_norm.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/multipliers/sparse_multipliers.hpp"

namespace convex::inline multiplier_sets {
namespace {

/// The same dependences in a basis in which no coefficient is large, and the multipliers with which its rows
/// alone pull the same: where rows are told in units far apart, those of another one keep no digit of the
/// least ones. u_p = Σ T(k, p) u_k takes the place of u_k where T(k, p) is largest, by a step of Gauss and
/// Jordan.
void take_rows_with_small_coefficients(Dependence& rows, Vector& lambda) {
  constexpr double large = 16;
  // Each step multiplies the volume of the basis by more than `large`.
  constexpr Index most_steps = 200;
  if (rows.T.size() == 0) return;
  for (Index step = 0; step < most_steps; ++step) {
    Index k = 0, p = 0;
    const double pivot = rows.T.cwiseAbs().maxCoeff(&k, &p);
    if (!(pivot > large) || !std::isfinite(pivot)) return;
    const Vector column = rows.T.col(p);
    const Vector row = rows.T.row(k).transpose() / column[k];
    Index &leaving = rows.basic[at(k)], &entering = rows.dependent[at(p)];
    const double weight = lambda[leaving] / column[k];
    for (Index i = 0; i < column.size(); ++i)
      if (i != k) lambda[rows.basic[at(i)]] -= column[i] * weight;
    lambda[leaving] = 0;
    lambda[entering] += weight;
    rows.T -= column * row.transpose();
    rows.T.row(k) = row.transpose();
    rows.T.col(p) = -column / column[k];
    rows.T(k, p) = 1 / column[k];
    std::swap(leaving, entering);
  }
}

/// Of one group, beside whatever the others have; false where none are found.
bool least_norm_of_group(const NearestPointProblem& problem, const Dependence& rows,
                         const std::vector<bool>& is_free, Vector& lambda) {
  const Index d = rows.T.cols(), k = rows.T.rows();
  std::vector<Index> names = rows.basic;
  names.insert(names.end(), rows.dependent.begin(), rows.dependent.end());
  Vector start(k + d);
  for (Index j = 0; j < k + d; ++j) start[j] = lambda[names[at(j)]];
  // From here on the d×d matrix below is slower than the sparse method, to which these are few equations: of
  // a thousand rows through one point it takes seconds.
  constexpr Index many = 100;
  if (d > std::max(k, many) && least_norm_multipliers(problem, names, lambda)) return true;
  Matrix N(k + d, d);
  N.topRows(k) = -rows.T;
  N.bottomRows(d).setIdentity();
  // With no entry of T large the condition of NᵀN is no obstacle; where the change of basis did not come to
  // that, nothing is known of the multipliers.
  constexpr double large = 0x1p20;
  if (rows.T.size() > 0 && !(rows.T.cwiseAbs().maxCoeff() <= large)) return false;
  std::vector<Index> signed_rows;
  for (Index j = 0; j < k + d; ++j)
    if (!is_free[at(names[static_cast<std::size_t>(j)])]) signed_rows.push_back(j);
  const ConstraintRows all{RowMatrix(N)};
  NearestPointProblem shortest{
      Metric::dense(N.transpose() * N), -N.transpose() * start, all.select(signed_rows), Vector(), {}};
  shortest.s.resize(static_cast<Index>(signed_rows.size()));
  for (std::size_t j = 0; j < signed_rows.size(); ++j)
    shortest.s[static_cast<Index>(j)] = -start[signed_rows[j]];
  const Solution solution = active_set(shortest, {.limit = 0});
  if (solution.q.size() != d) return false;
  const Vector best = start + N * solution.q;
  const double noise = 16 * unit_roundoff * start.cwiseAbs().maxCoeff();
  for (Index j = 0; j < k + d; ++j) {
    const Index a = names[at(j)];
    lambda[a] = std::abs(best[j]) <= noise ? 0 : best[j];
    if (!is_free[at(a)]) lambda[a] = std::max(0.0, lambda[a]);
  }
  return true;
}

/// What lambda misses of a reaction, put on the rows that others depend on.
bool put_missing_reaction_on_basis(const NearestPointProblem& problem, const Vector& reaction,
                                   const std::vector<Dependence>& groups, Vector& lambda) {
  std::vector<Index> basic;
  for (const Dependence& rows : groups) basic.insert(basic.end(), rows.basic.begin(), rows.basic.end());
  const auto k = static_cast<Index>(basic.size());
  const NearestPointProblem held{problem.A, problem.U.transpose_times(lambda) - reaction,
                                 problem.U.select(basic), Vector::Zero(k), indices_below(k)};
  const Solution pushed = active_set(held, {.limit = 0});
  if (pushed.lambda.size() != k) return false;
  lambda(basic) += pushed.lambda;
  return true;
}

Vector reaction_of(const NearestPointProblem& problem, const Solution& solution) {
  return problem.A.multiply(solution.q) - problem.z;
}

}  // namespace

bool is_same_reaction(const NearestPointProblem& problem, const Solution& solution, const Vector& lambda,
                      double tolerance) {
  const double small = tolerance * std::max(solution.force_norm, solution.acceleration_norm);
  return problem.A.dual_norm(problem.U.transpose_times(lambda - solution.lambda)) <= small ||
         problem.A.dual_norm(problem.U.transpose_times(lambda) - reaction_of(problem, solution)) <= small;
}

bool least_norm(const NearestPointProblem& problem, const Solution& solution, std::vector<Dependence> groups,
                const std::vector<bool>& is_free, double tolerance, Vector& lambda) {
  if (groups.empty()) return true;
  const auto is_finite = [&](const Dependence& rows) {
    return rows.T.allFinite() && lambda(rows.basic).allFinite();
  };
  if (!std::all_of(groups.begin(), groups.end(), is_finite)) return false;
  const Vector reaction = reaction_of(problem, solution);
  const auto missing = [&] { return problem.A.dual_norm(problem.U.transpose_times(lambda) - reaction); };
  for (Dependence& rows : groups) {
    take_rows_with_small_coefficients(rows, lambda);
    if (!least_norm_of_group(problem, rows, is_free, lambda)) return false;
  }
  constexpr int most_refinements = 3;
  constexpr double roundings = 64 * unit_roundoff;
  double left = missing();
  for (int i = 0; i < most_refinements; ++i) {
    if (left <= roundings * std::max(solution.force_norm, solution.acceleration_norm)) break;
    const Vector before = lambda;
    if (!put_missing_reaction_on_basis(problem, reaction, groups, lambda)) break;
    const bool is_found = std::all_of(groups.begin(), groups.end(), [&](const Dependence& rows) {
      return least_norm_of_group(problem, rows, is_free, lambda);
    });
    const double was = left;
    left = missing();
    if (is_found && left < was) continue;
    lambda = before;
    break;
  }
  return is_same_reaction(problem, solution, lambda, tolerance);
}

}  // namespace convex::inline multiplier_sets
