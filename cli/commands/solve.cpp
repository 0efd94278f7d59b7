#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <optional>

#include "cli/commands/command_line.hpp"
#include "cli/commands/solve.hpp"
#include "cli/drawing/mechanism_drawing.hpp"
#include "cli/each_file.hpp"
#include "cli/report/cone_report.hpp"
#include "cli/report/decomposition_report.hpp"
#include "cli/report/singular_report.hpp"
#include "cli/report/solve_progress.hpp"
#include "cli/resolved_scene.hpp"

namespace cli::inline commands {
namespace {

Answer solve_scene(Scene scene, const std::optional<DrawnScene>& drawn, const SolveOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const bool proved = scene.solve.method->name == "exact" || options.certify;
  std::optional<SolveProgress> progress(std::in_place);
  ProvedScene resolved = resolve_and_prove(scene, options.certify);
  mechanics::CertifiedSolution& found = resolved.found;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  // Part of reading the mechanism, like the evaluation whose rounding it is about.
  std::optional<double> as_evaluated;
  if (scene.written && found.certificate.level == convex::ProofLevel::none) {
    as_evaluated = settle_evaluation_error(scene, found.solution);
    found.certificate.error_bound = found.solution.primal.error_bound;
  }
  progress.reset();
  SolvedScene solved =
      solved_scene(scene, found.solution, seconds - found.solution.multipliers.range_seconds);
  solved.null_space = options.null_space;
  solved.sensitivity = options.sensitivity;
  solved.verbose = options.verbose || options.full_model;
  solved.asked_method = options.method.has_value();
  solved.as_evaluated = as_evaluated;
  if (proved) solved.certificate = found.certificate;
  if (found.exact) solved.exact = &*found.exact;
  solved.farkas = found.farkas;
  if (found.text) solved.text = &*found.text;
  solved.warnings = std::move(resolved.warnings);
  add_contact_warnings(solved);
  if (options.plot) draw(*options.plot, scene_drawing(solved, *drawn, options.plane));
  Exit exit = exit_code(found.solution.primal.status);
  if (options.certify && found.certificate.level == convex::ProofLevel::none)
    exit = std::max(exit, Exit::inaccurate);
  return {exit, options.json ? solve_json(solved) + "\n" : solve_text(solved), warning_lines(solved)};
}

Answer solve_liquid_file(const LiquidProblem& liquid, const Problem& problem, const std::string& file,
                         const SolveOptions& options) {
  require_liquid_settings(problem.solve, options);
  LiquidRequest request = options.liquid;
  request.tolerance = options.tolerance ? options.tolerance : problem.solve.tolerance;
  request.certify = options.certify;
  request.plot = options.plot;
  request.plane = options.plane;
  request.title = problem.title.empty() ? file : problem.title;
  const SolvedLiquid solved = solve_liquid_text(liquid.text, request);
  return {
      solved.exit(),
      options.json ? liquid_json(solved, file) + "\n" : heading(problem.title, file) + liquid_text(solved),
      liquid_warnings(solved)};
}

/// What is asked of contacts alone, of a problem that has none.
void require_no_contact_request(const SolveOptions& options, bool is_drawn) {
  const char* option = options.plot && !is_drawn ? "--plot"
                       : options.sensitivity     ? "--sensitivity"
                       : options.null_space      ? "--null-space"
                       : options.ranges          ? "--ranges"
                       : options.full_model      ? "--model full"
                                                 : nullptr;
  if (option != nullptr)
    throw convex::InvalidInput(
        std::string(option) +
        ": it is made of [system] and [projection], and the file has neither; take it out");
}

}  // namespace

Answer solve_problem(Problem problem, const std::string& file, const SolveOptions& options) {
  const auto* liquid = std::get_if<LiquidProblem>(&problem.content);
  const bool is_scene = std::holds_alternative<SystemProblem>(problem.content) ||
                        std::holds_alternative<ProjectionProblem>(problem.content);
  if (!is_scene) require_no_contact_request(options, liquid != nullptr);
  if (liquid != nullptr) return solve_liquid_file(*liquid, problem, file, options);
  require_no_liquid_request(options.liquid);
  if (const auto* decomposition = std::get_if<DecompositionProblem>(&problem.content)) {
    require_applicable(problem.solve, options);
    const SplitPoint split = split_point(*decomposition, problem.solve, options, options.certify);
    return {split.exit(),
            options.json ? split_json(split, file) + "\n" : heading(problem.title, file) + split_text(split)};
  }
  if (const auto* cone = std::get_if<ConeProblem>(&problem.content)) {
    require_cone_settings(problem.solve, options);
    const SolvedCone solved = solve_cone(*cone);
    return {Exit::solved,
            options.json ? cone_json(solved, file) + "\n" : heading(problem.title, file) + cone_text(solved)};
  }
  std::optional<DrawnScene> drawn;
  if (options.plot) drawn.emplace(problem);
  return solve_scene(make_scene(std::move(problem), file, options), drawn, options);
}

namespace {

Answer solve_file(const std::string& file, const SolveOptions& options) {
  if (options.plot) require_drawable(*options.plot);
  return solve_problem(read_problem_file(file, options), file, options);
}

Exit solve_files(const SolveOptions& options) {
  const auto refused = [&](const char* why) {
    return answered(options, {options.files.back(), ""}, [&]() -> Exit { throw convex::InvalidInput(why); });
  };
  if (options.plot && options.files.size() > 1)
    return refused("--plot takes one problem file; run the files one by one");
  if (options.plane && !options.plot)
    return refused("--plane goes with --plot; give a picture to draw it in");
  return print_for_each_file(options, [&](const std::string& file) { return solve_file(file, options); });
}

}  // namespace

void add_solve(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<SolveOptions>();
  CLI::App& command =
      add_command(program, "solve", "which contacts persist, with which acceleration and reactions", chosen,
                  [options] { return solve_files(*options); });
  add_files(command, *options);
  add_accuracy(command, *options);
  command.add_flag("--verbose", options->verbose,
                   "how the answer was found: method, parts, what was left out");
  command.add_flag("--ranges", options->ranges,
                   "ranges of multipliers that are not unique, also beyond 1000 contacts");
  command
      .add_option_function<std::string>(
          "--model", [options](const std::string& model) { options->full_model = model == "full"; },
          "reduced (default): no more than the scene needs; full: the whole at once, and what that costs")
      ->type_name("NAME")
      ->check(CLI::IsMember({"reduced", "full"}));
  command.add_flag("--null-space", options->null_space,
                   "a basis of the changes of multipliers that no motion feels, in --json");
  command.add_flag("--sensitivity", options->sensitivity,
                   "derivatives by forces and bounds, and margins of the contacts");
  add_proof(command, options->certify);
  command
      .add_option(
          "--plot", options->plot,
          "the decomposition drawn; of a liquid the pressure and the cavity: F.svg, F.png or F.pdf (by "
          "gnuplot)")
      ->type_name("FILE");
  command
      .add_option("--plane", options->plane, "the two coordinates that --plot draws, of more than two: x,y")
      ->type_name("X,Y");
  command
      .add_option("--onset", options->liquid.onset,
                  "of a liquid: the value of a parameter at which cavitation begins")
      ->type_name("NAME");
  command
      .add_option("--probe", options->liquid.probes, "of a liquid: p and d(div u)/dt there: \"x=0.3, y=0\"")
      ->type_name("POINT")
      ->allow_extra_args(false);
  add_table(command, "--data", options->liquid.data,
            "of a liquid: a table of the coordinates, p, growth, cavity (0 or 1)");
  command.add_option("--vtk", options->liquid.vtk, "of a liquid: the same for ParaView")->type_name("F.vti");
  command.add_flag("--velocity", options->liquid.velocity, "of a liquid: u as arrows in the --plot");
  command
      .add_option("--animate", options->liquid.animate,
                  "of a liquid: a page that plays inception as the parameter of --over grows")
      ->type_name("F.html");
  command.add_option("--over", options->liquid.over, "the values of a parameter that --animate plays")
      ->type_name("NAME=0:0.05:3");
}

}  // namespace cli::inline commands
