#include "cli/solve_report.hpp"

namespace cli {

SolvedScene solved_scene(const Scene& scene, const mechanics::GaussSolution& solution, double seconds) {
  using convex::Index;
  SolvedScene solved{scene, solution, {}, {}, seconds};
  if (!solved.has_answer()) return solved;
  const std::size_t count = scene.constraints.size();
  solved.states.assign(count, ConstraintState::inactive);
  for (Index a : scene.contacts) solved.states[static_cast<std::size_t>(a)] = ConstraintState::opens;
  for (Index row : solution.multipliers.tight)
    solved.states[static_cast<std::size_t>(scene.contacts[static_cast<std::size_t>(row)])] =
        ConstraintState::persists;
  // Over K, d²f/dt² is the slack of the solution, more accurate than a new evaluation.
  solved.second_rates = scene.system ? scene.system->second_rates(scene.state, solution.primal.q)
                                     : convex::Vector(convex::Vector::Zero(static_cast<Index>(count)));
  for (std::size_t k = 0; k < scene.contacts.size(); ++k)
    solved.second_rates[scene.contacts[k]] = solution.primal.slack[static_cast<Index>(k)];
  return solved;
}

const char* name(ConstraintState state) {
  switch (state) {
    case ConstraintState::persists:
      return "persists";
    case ConstraintState::opens:
      return "opens";
    case ConstraintState::inactive:
      return "inactive";
  }
  return "";
}

}  // namespace cli
