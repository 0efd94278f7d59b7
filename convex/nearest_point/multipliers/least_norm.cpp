#include "convex/nearest_point/multipliers/least_norm.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/linear_algebra/householder.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/multipliers/least_norm_by_newton.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"

namespace convex::inline multiplier_sets {
namespace {

/// lambda of least norm as the nearest point to 0 in {lambda : lambda_k + Σ T(k, p) lambda_p the same for
/// each k, lambda >= 0 on one-sided rows}, every entry rounded once. start: lambda of the rows `names`, those
/// of T first.
bool least_norm_in_fractions(const Dependence& rows, const std::vector<Index>& names,
                             const std::vector<bool>& is_free, const Vector& start, Vector& lambda) {
  const Index d = rows.T.cols(), k = rows.T.rows();
  RowMatrix U = RowMatrix::Zero(k, k + d);
  U.leftCols(k).setIdentity();
  U.rightCols(d) = rows.T;
  std::vector<Index> two_sided(static_cast<std::size_t>(k));
  std::iota(two_sided.begin(), two_sided.end(), Index{0});
  Vector s = U * start;
  for (Index j = 0; j < k + d; ++j) {
    if (is_free[static_cast<std::size_t>(names[static_cast<std::size_t>(j)])]) continue;
    U.conservativeResize(U.rows() + 1, k + d);
    U.row(U.rows() - 1) = Vector::Unit(k + d, j).transpose();
    s.conservativeResize(U.rows());
    s[U.rows() - 1] = 0;
  }
  const NearestPointProblem problem{Metric::identity(k + d), Vector::Zero(k + d),
                                    ConstraintRows(std::move(U)), std::move(s), std::move(two_sided)};
  const Solution solution = exact_method(problem, {});
  if (solution.status != Status::solved && solution.status != Status::inaccurate) return false;
  for (Index j = 0; j < k + d; ++j) lambda[names[static_cast<std::size_t>(j)]] = solution.q[j];
  return true;
}

}  // namespace

void least_norm(const Dependence& rows, const std::vector<bool>& is_free, Vector& lambda) {
  const Index d = rows.T.cols(), k = rows.T.rows();
  std::vector<Index> names = rows.basic;
  names.insert(names.end(), rows.dependent.begin(), rows.dependent.end());
  Vector start(k + d);
  for (Index j = 0; j < k + d; ++j) start[j] = lambda[names[static_cast<std::size_t>(j)]];
  if (!start.allFinite()) return;  // a multiplier is beyond doubles
  const auto take = [&](const Vector& best) {
    const double noise = 16 * unit_roundoff * start.cwiseAbs().maxCoeff();
    for (Index j = 0; j < k + d; ++j) {
      const Index a = names[static_cast<std::size_t>(j)];
      lambda[a] = std::abs(best[j]) <= noise ? 0 : best[j];
      if (!is_free[static_cast<std::size_t>(a)]) lambda[a] = std::max(0.0, lambda[a]);
    }
  };
  // From here on the d×d matrix below is slower than a few k×k ones: of a thousand rows through one point it
  // takes seconds.
  constexpr Index many = 100;
  if (d > std::max(k, many)) {
    std::vector<bool> free;
    for (Index a : names) free.push_back(is_free[static_cast<std::size_t>(a)]);
    if (Vector best = start; least_norm_by_newton(rows.T, free, best)) return take(best);
  }
  Matrix N(k + d, d);
  N.topRows(k) = -rows.T;
  N.bottomRows(d).setIdentity();
  // The condition of N is at most about the size of T. Beyond, as for rows told in units far apart, each
  // multiplier needs digits of its own; where fractions cost too much, an orthonormal basis of the columns
  // serves.
  constexpr double steep = 1e5;
  constexpr Index few = 24;
  if (rows.T.norm() > steep) {
    if (k + d <= few && least_norm_in_fractions(rows, names, is_free, start, lambda)) return;
    N = linear_algebra::Householder(N).Q(d);
  }
  std::vector<Index> signed_rows;
  for (Index j = 0; j < k + d; ++j)
    if (!is_free[static_cast<std::size_t>(names[static_cast<std::size_t>(j)])]) signed_rows.push_back(j);
  const ConstraintRows all{RowMatrix(N)};
  NearestPointProblem problem{
      Metric::dense(N.transpose() * N), -N.transpose() * start, all.select(signed_rows), Vector(), {}};
  problem.s.resize(static_cast<Index>(signed_rows.size()));
  for (std::size_t j = 0; j < signed_rows.size(); ++j)
    problem.s[static_cast<Index>(j)] = -start[signed_rows[j]];
  const Solution solution = active_set(problem, {.limit = 0});
  if (solution.q.size() != d) return;
  take(start + N * solution.q);
}

}  // namespace convex::inline multiplier_sets
