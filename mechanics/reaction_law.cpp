#include "mechanics/reaction_law.hpp"

#include <algorithm>
#include <cmath>

#include "convex/laws/worst_check.hpp"
#include "mechanics/gauss_function.hpp"

namespace mechanics {

convex::Check reaction_law(const convex::NearestPointProblem& problem, const GaussSolution& solution) {
  constexpr double roundings = 16 * convex::unit_roundoff;
  const Vector &q = solution.primal.q, &lambda = solution.multipliers.least_norm;
  const Vector inertial = gauss_gradient(problem, q), applied = problem.U.transpose_times(lambda);
  const Vector weight = problem.A.diagonal().cwiseSqrt();  // |a_ik| <= sqrt(a_ii a_kk)
  Vector terms = problem.z.cwiseAbs() + q.cwiseAbs().dot(weight) * weight;
  for (Index a = 0; a < problem.rows(); ++a)
    if (lambda[a] != 0)
      problem.U.for_each_entry(a, [&](Index i, double u) { terms[i] += std::abs(lambda[a] * u); });
  const double steps = std::sqrt(static_cast<double>(problem.dimension() + problem.rows()));
  convex::WorstCheck worst("R is the sum of lambda_a u_a in every coordinate");
  for (Index i = 0; i < q.size(); ++i) {
    const double R = solution.reaction[i];
    worst.take(std::min(std::abs(R - applied[i]), std::abs(R - inertial[i])),
               roundings * steps * terms[i] + solution.taken_for_zero * weight[i]);
  }
  return worst.check();
}

}  // namespace mechanics
