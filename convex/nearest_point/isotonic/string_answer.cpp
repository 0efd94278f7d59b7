#include "convex/nearest_point/isotonic/string_answer.hpp"

#include <cmath>

#include "convex/nearest_point/optimality/residuals.hpp"

namespace convex {
namespace {

/// A slack below this part of its terms is 0.
constexpr double silence = 0x1p-90;

}  // namespace

Solution string_answer(const NearestPointProblem& problem, const Accuracy& accuracy,
                       const DoubleDoubleVector& q, Vector lambda, double missing) {
  Solution found;
  found.q = q.hi;
  found.lambda = std::move(lambda);
  found.slack = Vector::Zero(problem.rows());
  for (Index a = 0; a < problem.rows(); ++a) {
    if (std::abs(found.lambda[a]) > 0) continue;
    const DoubleDouble reach = add(problem.U.dot(a, q), {-problem.s[a], 0});
    const double terms = std::abs(problem.s[a]) + std::abs(reach.hi);
    found.slack[a] = std::abs(reach.value()) <= silence * terms ? 0 : std::max(0.0, reach.value());
  }
  const Vector& d = problem.A.diagonal();
  found.acceleration_norm = std::sqrt(found.q.cwiseAbs2().dot(d));
  found.force_norm = std::sqrt(problem.z.cwiseAbs2().cwiseQuotient(d).sum());
  found.residuals =
      residuals(problem, found.q, found.lambda,
                KnownParts{Vector(), found.slack, {}, found.acceleration_norm, found.force_norm});
  found.rounding = std::sqrt(q.lo.cwiseAbs2().dot(d));
  // Sums of n terms in twice the precision.
  const double scale = std::max(found.acceleration_norm, found.force_norm), n = static_cast<double>(q.size());
  found.error_bound = found.rounding + missing + 8 * unit_roundoff * unit_roundoff * n * scale;
  const bool close = found.error_bound <= accuracy.tolerance * std::max(1.0, found.acceleration_norm);
  found.status = close ? Status::solved : Status::inaccurate;
  return found;
}

}  // namespace convex
