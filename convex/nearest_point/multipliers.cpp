#include "convex/nearest_point/multipliers.hpp"

#include <cmath>

#include "convex/nearest_point/active_set.hpp"
#include "convex/nearest_point/multiplier_tableau.hpp"
#include "convex/nearest_point/residuals.hpp"
#include "convex/nearest_point/structure/sparse_multipliers.hpp"
#include "convex/nearest_point/working_set.hpp"

namespace convex {
namespace {

/// Beyond so many multiplications for a dense factor of the tight rows, sparse factors tell whether
/// multipliers are unique; their ranges are then not found.
constexpr double most_dense_work = 3e9;

std::vector<bool> marked(Index count, const std::vector<Index>& chosen) {
  std::vector<bool> mark(static_cast<std::size_t>(count), false);
  for (Index a : chosen) mark[static_cast<std::size_t>(a)] = true;
  return mark;
}

/// The tight rows split into independent ones, `basic`, and the others with their expansions: u_p = Σ T(k, p)
/// u_k.
struct Dependence {
  std::vector<Index> basic, dependent;
  Matrix T;
};

Dependence dependence(const NearestPointProblem& problem, const std::vector<Index>& basis,
                      const std::vector<Index>& tight) {
  using Set = WorkingSet<Eigen::Dynamic>;
  Set set(problem);
  Matrix whitened = whitened_rows(problem, basis);
  set.append_block(basis, whitened, 0);
  Dependence found;
  Set::Split split;
  for (Index a : tight) {
    if (set.holds(a)) continue;
    set.split(a, split);
    if (split.rho > 0 && set.size() < set.factor().capacity())
      set.append(a, split, 0);
    else
      found.dependent.push_back(a);
  }
  found.basic = set.rows();
  found.T.resize(set.size(), static_cast<Index>(found.dependent.size()));
  for (std::size_t p = 0; p < found.dependent.size(); ++p) {
    set.split(found.dependent[p], split);
    const double noise = 64 * unit_roundoff * split.magnitude;  // of a coefficient times its row's length
    for (Index k = 0; k < set.size(); ++k) {
      const double r = split.coefficients[k];
      found.T(k, static_cast<Index>(p)) = std::abs(r) * set.factor().length(k) > noise ? r : 0;
    }
  }
  return found;
}

/// lambda of least norm: with lambda = lambda_0 + N mu, N the null vectors e_p - Σ T(k, p) e_k, the nearest
/// point to 0 in {mu : lambda >= 0 on one-sided rows}.
void least_norm(const Dependence& rows, const std::vector<bool>& is_free, Vector& lambda) {
  const Index d = rows.T.cols(), k = rows.T.rows();
  std::vector<Index> names = rows.basic;
  names.insert(names.end(), rows.dependent.begin(), rows.dependent.end());
  RowMatrix N(k + d, d);
  N.topRows(k) = -rows.T;
  N.bottomRows(d).setIdentity();
  Vector start(k + d);
  for (Index j = 0; j < k + d; ++j) start[j] = lambda[names[static_cast<std::size_t>(j)]];
  std::vector<Index> signed_rows;
  for (Index j = 0; j < k + d; ++j)
    if (!is_free[static_cast<std::size_t>(names[static_cast<std::size_t>(j)])]) signed_rows.push_back(j);
  const ConstraintRows all(N);
  NearestPointProblem problem{
      Metric::dense(N.transpose() * N), -N.transpose() * start, all.select(signed_rows), Vector(), {}};
  problem.s.resize(static_cast<Index>(signed_rows.size()));
  for (std::size_t j = 0; j < signed_rows.size(); ++j)
    problem.s[static_cast<Index>(j)] = -start[signed_rows[j]];
  const Solution solution = active_set(problem);
  if (solution.q.size() != d) return;
  const Vector best = start + N * solution.q;
  const double noise = 16 * unit_roundoff * start.cwiseAbs().maxCoeff();
  for (Index j = 0; j < k + d; ++j) {
    const Index a = names[static_cast<std::size_t>(j)];
    lambda[a] = std::abs(best[j]) <= noise ? 0 : best[j];
    if (!is_free[static_cast<std::size_t>(a)]) lambda[a] = std::max(0.0, lambda[a]);
  }
}

}  // namespace

std::vector<Index> tight_rows(const NearestPointProblem& problem, const Solution& solution,
                              double tolerance) {
  const double scale = std::max(solution.acceleration_norm, solution.force_norm);
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  const std::vector<bool> basis = marked(problem.rows(), solution.basis);
  std::vector<Index> candidates;
  for (Index a = 0; a < problem.rows(); ++a)
    if (!two_sided[static_cast<std::size_t>(a)] && !basis[static_cast<std::size_t>(a)] &&
        !(solution.slack[a] <= 0))
      candidates.push_back(a);
  const Vector length = dual_lengths(problem, candidates);
  std::vector<Index> tight;
  for (Index a = 0; a < problem.rows(); ++a)
    if (two_sided[static_cast<std::size_t>(a)] || basis[static_cast<std::size_t>(a)] ||
        solution.slack[a] <= tolerance * (std::abs(problem.s[a]) + length[a] * scale))
      tight.push_back(a);
  return tight;
}

Multipliers multipliers(const NearestPointProblem& problem, const Solution& solution, double tolerance,
                        bool want_ranges) {
  Multipliers found;
  found.least_norm = solution.lambda;
  found.tight = tight_rows(problem, solution, tolerance);
  const std::vector<bool> is_free = marked(problem.rows(), problem.two_sided);
  std::vector<Interval> ranges(static_cast<std::size_t>(problem.rows()));
  for (Index a = 0; a < problem.rows(); ++a)
    ranges[static_cast<std::size_t>(a)] = {solution.lambda[a], solution.lambda[a]};

  const double tight_count = static_cast<double>(found.tight.size()),
               n = static_cast<double>(problem.dimension());
  if (n * tight_count * std::min(n, tight_count) > most_dense_work) {
    std::vector<Index> loaded;
    for (Index a : found.tight)
      if (solution.lambda[a] != 0 || is_free[static_cast<std::size_t>(a)]) loaded.push_back(a);
    found.unique = sparse_rows_are_independent(problem, loaded);
    if (found.unique)
      found.ranges = std::move(ranges);
    else
      least_norm_multipliers(problem, found.tight, found.least_norm);
    return found;
  }

  const bool all_in_basis = found.tight.size() == solution.basis.size();
  const Dependence rows = all_in_basis ? Dependence{} : dependence(problem, solution.basis, found.tight);
  if (!rows.dependent.empty()) {
    Vector value(static_cast<Index>(rows.basic.size()));
    for (std::size_t k = 0; k < rows.basic.size(); ++k)
      value[static_cast<Index>(k)] = solution.lambda[rows.basic[k]];
    MultiplierTableau tableau(rows.basic, value, rows.dependent, rows.T, is_free);
    // They are unique when every dependent row keeps its multiplier 0.
    const double noise =
        tolerance * std::max(solution.lambda.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    for (Index p : rows.dependent) {
      const Interval range = tableau.range(p);
      ranges[static_cast<std::size_t>(p)] = range;
      if (range.high - range.low > noise) found.unique = false;
      if (!found.unique && !want_ranges) break;
    }
    if (!found.unique) {
      if (want_ranges)
        for (Index a : rows.basic) ranges[static_cast<std::size_t>(a)] = tableau.range(a);
      least_norm(rows, is_free, found.least_norm);
    }
  }
  if (want_ranges || found.unique) found.ranges = std::move(ranges);
  return found;
}

}  // namespace convex
