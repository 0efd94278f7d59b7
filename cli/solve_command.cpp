#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "cli/commands.hpp"
#include "cli/each_file.hpp"
#include "cli/solve_report.hpp"

namespace cli {
namespace {

Exit exit_code(convex::Status status) {
  switch (status) {
    case convex::Status::solved:
      return Exit::solved;
    case convex::Status::infeasible:
      return Exit::no_solution;
    case convex::Status::inaccurate:
    case convex::Status::gave_up:
      return Exit::inaccurate;
  }
  return Exit::inaccurate;
}

}  // namespace

Exit solve_command(const Options& options) {
  bool first = true;
  return for_each_file(options, [&](const std::string& file) {
    const Scene scene = read_scene(file, options);
    const auto start = std::chrono::steady_clock::now();
    const mechanics::GaussSolution solution = mechanics::solve(scene.problem, scene.solve);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const SolvedScene solved = solved_scene(scene, solution, seconds);
    if (options.json)
      fmt::print("{}\n", solve_json(solved));
    else if (!options.quiet)
      fmt::print("{}{}", first ? "" : "\n", solve_text(solved));
    first = false;
    return exit_code(solution.primal.status);
  });
}

}  // namespace cli
