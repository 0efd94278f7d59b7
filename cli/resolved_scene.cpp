#include "cli/resolved_scene.hpp"

#include "mechanics/singular/resolution.hpp"

namespace cli {

mechanics::GaussSolution solve_plainly(const Scene& scene) {
  mechanics::GaussSolution found = mechanics::solve(scene.problem, scene.solve);
  const bool as_written = static_cast<convex::Index>(scene.contacts.size()) == scene.problem.rows();
  if (!scene.problem.radii || !as_written) return found;  // else rows were added that the text does not have
  mechanics::decide_on_exact_data(
      found, scene.problem, scene.solve, [&]() -> std::optional<convex::ExactProblem> {
        if (!scene.written) return scene.exact.make();
        std::optional<mechanics::TextProblem> text =
            mechanics::problem_from_text(*scene.written->system, scene.written->text, scene.contacts);
        if (!text || !text->is_exact) return std::nullopt;
        return std::move(text->problem.middle);
      });
  return found;
}

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
