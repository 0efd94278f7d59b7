#include "cli/resolved_scene.hpp"

#include "mechanics/singular/resolution.hpp"

namespace cli {

std::vector<mechanics::Warning> resolve_scene(
    Scene& scene, const std::function<const mechanics::GaussSolution&(const Scene&)>& solve) {
  if (!scene.system || scene.problem.two_sided.empty()) {
    solve(scene);
    return {};
  }
  const mechanics::GaussProblem gauss{scene.problem, {scene.contacts, *scene.rates}};
  mechanics::Resolution found =
      mechanics::resolve(*scene.system, scene.state, gauss,
                         [&](const convex::NearestPointProblem& problem) -> const mechanics::GaussSolution& {
                           scene.problem = problem;
                           scene.exact.make = [problem] { return convex::exact_problem(problem); };
                           return solve(scene);
                         });
  scene.added = std::move(found.added);
  scene.is_settled = found.is_settled;
  return std::move(found.warnings);
}

}  // namespace cli
