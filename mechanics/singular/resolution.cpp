#include "mechanics/singular/resolution.hpp"

#include <random>

namespace mechanics::inline singular_states {

Resolution resolve(const LagrangianSystem& system, const State& state, const StateRadii& radii,
                   const GaussProblem& gauss,
                   const std::function<const GaussSolution&(const convex::NearestPointProblem&)>& solve) {
  Resolution found{gauss.problem, {}, false, {}};
  SingularState singular(system, state, radii, gauss);
  found.is_settled = singular.settle(found.problem);
  bool infeasible = false;
  for (;;) {
    const GaussSolution& answer = solve(found.problem);
    infeasible = answer.primal.status == convex::Status::infeasible;
    if (infeasible && answer.as_written) break;  // no rounding contradicts itself
    if (infeasible || answer.primal.status == convex::Status::gave_up) {
      auto fewer = singular.without_repeated(found.problem);
      if (!fewer) break;
      found.problem = std::move(*fewer);
      found.is_settled = true;
      continue;
    }
    const std::vector<AddedRow> missing = singular.missing(found.problem, answer);
    if (missing.empty()) break;
    found.problem = singular.extended(found.problem, missing);
    found.added.insert(found.added.end(), missing.begin(), missing.end());
  }
  found.warnings = singular.warnings(found.added, infeasible);
  return found;
}

Resolution resolve_for_every_force(const LagrangianSystem& system, const State& state,
                                   const StateRadii& radii, const GaussProblem& gauss) {
  Resolution found{gauss.problem, {}, false, {}};
  SingularState singular(system, state, radii, gauss);
  if (!singular.may_add_rows()) return found;
  found.is_settled = singular.settle(found.problem);
  // An equation that holds for one force drawn at random holds for all, but for an accident of probability 0.
  std::mt19937_64 random(1966);
  std::normal_distribution<double> normal;
  Vector draw = gauss.problem.A.diagonal().cwiseSqrt();
  for (double& entry : draw) entry *= normal(random);
  double size = 1;
  for (bool is_drawn = false;;) {
    convex::NearestPointProblem two_sided = singular.without_one_sided(found.problem);
    if (is_drawn) two_sided.z += size * draw;
    const GaussSolution answer = solve(two_sided);
    if (answer.primal.status == convex::Status::infeasible ||
        answer.primal.status == convex::Status::gave_up) {
      auto fewer = singular.without_repeated(found.problem);
      if (!fewer) break;
      found.problem = std::move(*fewer);
      found.is_settled = true;
      continue;
    }
    const std::vector<AddedRow> missing = singular.missing(two_sided, answer);
    if (missing.empty() && is_drawn) break;
    found.problem = singular.extended(found.problem, missing);
    found.added.insert(found.added.end(), missing.begin(), missing.end());
    size = std::max({size, answer.primal.acceleration_norm, answer.primal.force_norm});
    is_drawn = is_drawn || missing.empty();
  }
  found.warnings = singular.warnings({}, false);
  return found;
}

}  // namespace mechanics::inline singular_states
