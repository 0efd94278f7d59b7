#include "convex/nearest_point/optimality/sparse_residuals.hpp"

#include <algorithm>
#include <cmath>

#include "convex/double_double.hpp"
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

/// ||Aq - z - Uᵀlambda||_(A⁻¹), entries in twice the working precision.
double unbalanced(const NearestPointProblem& problem, const Vector& q, const Vector& lambda) {
  const SparseRows& U = problem.U.sparse();
  const Vector& d = problem.A.diagonal();
  DoubleDoubleVector sum(problem.z);
  for (Index a = 0; a < U.rows(); ++a) {
    if (!(std::abs(lambda[a]) > 0)) continue;
    const StoredRow row = stored_row(U, a);
    for (Index k = 0; k < row.count; ++k) {
      const DoubleDouble term = exact_product(row.value[k], lambda[a]);
      const DoubleDouble both = two_sum(sum.hi[row.place[k]], term.hi);
      sum.hi[row.place[k]] = both.hi;
      sum.lo[row.place[k]] += both.lo + term.lo;
    }
  }
  double square = 0;
  for (Index i = 0; i < q.size(); ++i) {
    accumulate_product(d[i], {-q[i], 0}, sum.hi[i], sum.lo[i]);
    const double rest = sum.hi[i] + sum.lo[i];
    square += rest * rest / d[i];
  }
  return std::sqrt(square);
}

}  // namespace

Residuals sparse_residuals(const NearestPointProblem& problem, const Solution& judged) {
  return sparse_residuals(problem, judged, unbalanced(problem, judged.q, judged.lambda), 0, problem.rows());
}

Residuals sparse_residuals(const NearestPointProblem& problem, const Solution& judged, double stationarity,
                           Index first, Index end) {
  const SparseRows& U = problem.U.sparse();
  const Vector &d = problem.A.diagonal(), &q = judged.q, &lambda = judged.lambda, &slack = judged.slack;
  const double q_norm = judged.acceleration_norm, scale = std::max(q_norm, judged.force_norm);
  const double largest = end > first ? lambda.cwiseAbs().maxCoeff() : 0;
  Residuals found;
  double gap = 0.5 * stationarity * stationarity;
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
    const double length = std::sqrt(square);
    const double row_scale = size + length * q_norm;
    const double violation = two_sided ? std::abs(rest) : std::max(0.0, -rest);
    gap += lambda[a] * rest;
    // A violation on a row of scale 0 (at rest, s = 0) is relative to what z could do to it instead.
    const double over = row_scale > 0 ? row_scale : length * scale;
    if (!(over > 0)) continue;
    found.feasibility = std::max(found.feasibility, violation / over);
    if (largest > 0)
      found.complementarity = std::max(found.complementarity, std::abs(lambda[a] / largest * rest) / over);
  }
  if (scale > 0) {
    found.stationarity = stationarity / scale;
    found.duality_gap = std::sqrt(std::max(0.0, gap)) / scale;
  }
  return found;
}

}  // namespace convex::inline optimality
