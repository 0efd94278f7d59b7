#include "convex/nearest_point/optimality/sparse_residuals.hpp"

#include <algorithm>
#include <cmath>

#include "convex/double_double.hpp"
#include "convex/nearest_point/optimality/gathered_residuals.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline optimality {
namespace {

/// A row as it is stored.
struct StoredRow {
  Index count;
  const int* place;
  const double* value;
};

StoredRow stored_row(const SparseRows& U, Index a) {
  const Index begin = U.outerIndexPtr()[a];
  return {U.outerIndexPtr()[a + 1] - begin, U.innerIndexPtr() + begin, U.valuePtr() + begin};
}

/// The product as a pair; entries of incidence are 1 and -1, and then it is exact.
DoubleDouble exact_product(double value, double x) {
  if (std::abs(value) == 1) return {value * x, 0};
  return two_product(value, x);
}

/// u_a·q - s_a in twice the working precision.
double precise_slack(const StoredRow& row, const Vector& q, double s) {
  RunningSum sum;
  for (Index k = 0; k < row.count; ++k) sum.add(exact_product(row.value[k], q[row.place[k]]));
  sum.add(-s);
  return sum.value();
}

double terms(const StoredRow& row, const Vector& q) {
  double sum = 0;
  for (Index k = 0; k < row.count; ++k) sum += std::abs(row.value[k] * q[row.place[k]]);
  return sum;
}

}  // namespace

Residuals sparse_residuals(const NearestPointProblem& problem, const Solution& answer) {
  return sparse_residuals(
      problem, answer,
      problem.A.dual_norm(stationarity_residual(problem, DoubleDoubleVector(answer.q), answer.lambda)), 0,
      problem.rows());
}

Residuals sparse_residuals(const NearestPointProblem& problem, const Solution& answer, double stationarity,
                           Index first, Index end) {
  const SparseRows& U = problem.U.sparse();
  const Vector &d = problem.A.diagonal(), &q = answer.q, &lambda = answer.lambda, &slack = answer.slack;
  GatheredResiduals found(stationarity, answer.acceleration_norm,
                          std::max(answer.acceleration_norm, answer.force_norm),
                          end > first ? lambda.cwiseAbs().maxCoeff() : 0);
  auto next_two_sided = std::lower_bound(problem.two_sided.begin(), problem.two_sided.end(), first);
  for (Index a = first; a < end; ++a) {
    const bool two_sided = next_two_sided != problem.two_sided.end() && *next_two_sided == a;
    next_two_sided += two_sided;
    const bool loaded = std::abs(lambda[a]) > 0;
    const StoredRow row = stored_row(U, a);
    const double size = std::abs(problem.s[a]);
    double rest = slack[a];
    if (rest > 0 && !two_sided && !loaded && rest > near_zero * (size + terms(row, q))) continue;
    rest = precise_slack(row, q, problem.s[a]);
    if ((!loaded && rest >= 0 && !two_sided) || !(std::abs(rest) > 0)) continue;
    double square = 0;
    for (Index k = 0; k < row.count; ++k) square += row.value[k] * row.value[k] / d[row.place[k]];
    found.add(problem.s[a], std::sqrt(square), lambda[a], rest, two_sided);
  }
  return found.all();
}

}  // namespace convex::inline optimality
