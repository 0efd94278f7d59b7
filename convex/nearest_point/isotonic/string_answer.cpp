#include "convex/nearest_point/isotonic/string_answer.hpp"

#include <cmath>
#include <limits>

#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"

namespace convex::inline isotonic {
Solution string_answer(const NearestPointProblem& problem, const Accuracy& accuracy,
                       const DoubleDoubleVector& q, Vector lambda, double missing,
                       const std::function<std::optional<int>(Index)>& sign_of) {
  const Vector& d = problem.A.diagonal();
  Solution found;
  found.q = q.hi;
  found.lambda = std::move(lambda);
  found.slack = Vector::Zero(problem.rows());
  found.acceleration_norm = std::sqrt(found.q.cwiseAbs2().dot(d));
  found.force_norm = std::sqrt(problem.z.cwiseAbs2().cwiseQuotient(d).sum());
  // Sums of n terms in twice the precision.
  const double scale = std::max(found.acceleration_norm, found.force_norm), n = static_cast<double>(q.size()),
               sums = 8 * unit_roundoff * unit_roundoff * n * scale;
  const Vector unit = d.cwiseSqrt().cwiseInverse();
  for (Index a = 0; a < problem.rows(); ++a) {
    if (std::abs(found.lambda[a]) > 0) continue;
    found.slack[a] = std::max(0.0, slack(problem, a, q).value());
    if (found.slack[a] > (missing + sums) * problem.U.absolute_dot(a, unit)) continue;
    const std::optional<int> sign = sign_of(a);
    if (!sign) found.undecided = open_question::degenerate_rows;
    found.slack[a] =
        sign && *sign > 0 ? std::max(found.slack[a], std::numeric_limits<double>::denorm_min()) : 0;
  }
  found.residuals = residuals(problem, found);
  found.rounding = std::sqrt(q.lo.cwiseAbs2().dot(d));
  found.error_bound = found.rounding + missing + sums;
  found.status = found.is_within(accuracy) && found.undecided.empty() ? Status::solved : Status::inaccurate;
  return found;
}

}  // namespace convex::inline isotonic
