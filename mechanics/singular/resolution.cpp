#include "mechanics/singular/resolution.hpp"

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

}  // namespace mechanics::inline singular_states
