#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "cli/commands.hpp"
#include "cli/cone_report.hpp"
#include "cli/decomposition_report.hpp"
#include "cli/each_file.hpp"
#include "cli/solve_report.hpp"

namespace cli {
namespace {

Answer solve_scene(const Scene& scene, const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const mechanics::GaussSolution solution = mechanics::solve(scene.problem, scene.solve);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const SolvedScene solved = solved_scene(scene, solution, seconds);
  return {exit_code(solution.primal.status), options.json ? solve_json(solved) + "\n" : solve_text(solved)};
}

Answer solve_file(const std::string& file, const Options& options) {
  Problem problem = read_problem_file(file);
  if (const auto* decomposition = std::get_if<DecompositionProblem>(&problem.content)) {
    require_applicable(problem.solve, options);
    const SplitPoint split = split_point(*decomposition, problem.solve, options);
    return {exit_code(split.split.status),
            options.json ? split_json(split, file) + "\n" : heading(problem.title, file) + split_text(split)};
  }
  if (const auto* cone = std::get_if<ConeProblem>(&problem.content)) {
    require_cone_settings(problem.solve, options);
    const SolvedCone solved = solve_cone(*cone);
    return {Exit::solved,
            options.json ? cone_json(solved, file) + "\n" : heading(problem.title, file) + cone_text(solved)};
  }
  return solve_scene(make_scene(std::move(problem), file, options), options);
}

}  // namespace

Exit solve_command(const Options& options) {
  bool first = true;
  return for_each_file(options, [&](const std::string& file) {
    const Answer answer = solve_file(file, options);
    if (options.json || !options.quiet) fmt::print("{}{}", first || options.json ? "" : "\n", answer.text);
    first = false;
    return answer.exit;
  });
}

}  // namespace cli
