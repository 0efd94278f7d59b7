#include "convex/nearest_point/structure/chain.hpp"

#include <cmath>

#include "convex/nearest_point/residuals.hpp"
#include "convex/nearest_point/structure/pooling.hpp"

namespace convex {
namespace {

/// A slack below this part of its terms is 0.
constexpr double silence = 0x1p-90;

}  // namespace

std::optional<Solution> solve_chain(const NearestPointProblem& problem, const Accuracy& accuracy) {
  const Strings strings = find_strings(problem, 0);
  if (strings.count() != 1) return std::nullopt;
  Pooling pooling(problem, strings);
  pooling.pool(problem.z);
  pooling.refine(problem.z, Vector());
  Solution found;
  found.method = "chain";
  const DoubleDoubleVector& q = pooling.q();
  found.q = q.hi;
  found.lambda = pooling.lambda();
  found.slack = Vector::Zero(problem.rows());
  found.basis.reserve(static_cast<std::size_t>(problem.rows()));
  for (Index a = 0; a < problem.rows(); ++a)
    if (!(found.lambda[a] > 0)) {
      const DoubleDouble reach = add(problem.U.dot(a, q), {-problem.s[a], 0});
      const double terms = std::abs(problem.s[a]) + std::abs(reach.hi);
      found.slack[a] = std::abs(reach.value()) <= silence * terms ? 0 : std::max(0.0, reach.value());
    } else {
      found.basis.push_back(a);
    }
  found.steps = static_cast<Index>(found.basis.size());
  found.acceleration_norm = problem.A.norm(found.q);
  found.force_norm = problem.A.dual_norm(problem.z);
  found.residuals = residuals(problem, found.q, found.lambda,
                              KnownParts{problem.U.lengths(problem.A.diagonal().cwiseInverse()),
                                         found.slack,
                                         {},
                                         found.acceleration_norm,
                                         found.force_norm});
  found.rounding = problem.A.norm(q.lo);
  // Sums of n terms in twice the precision.
  const double scale = std::max(found.acceleration_norm, found.force_norm), n = static_cast<double>(q.size());
  found.error_bound = found.rounding + 8 * unit_roundoff * unit_roundoff * n * scale;
  const bool close = found.error_bound <= accuracy.tolerance * std::max(1.0, found.acceleration_norm);
  found.status = close ? Status::solved : Status::inaccurate;
  found.model.islands = {{found.method, problem.dimension(), problem.rows(), 0, 8 * n, 0}};
  return found;
}

}  // namespace convex
