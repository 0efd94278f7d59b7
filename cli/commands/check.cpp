#include <CLI/CLI.hpp>

#include <chrono>

#include "cli/commands/check_map.hpp"
#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/json_writer.hpp"
#include "cli/report/checks_report.hpp"
#include "cli/report/cone_report.hpp"
#include "cli/report/decomposition_report.hpp"
#include "cli/report/singular_report.hpp"
#include "cli/resolved_scene.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/laws/cone_laws.hpp"
#include "convex/laws/laws.hpp"
#include "mechanics/gauss_laws.hpp"

namespace cli::inline commands {
namespace {

/// What `moreau check` is told.
struct CheckOptions : FileOptions, SceneOptions {
  bool catalogue = false;  ///< the whole language instead of files
  bool certify = false;    ///< of the catalogue: what is proved of it
  MapOptions map;          ///< a map instead of files
};

/// An object of a solve with the checks behind its own keys.
template <class WriteSolve>
std::string with_checks(const convex::LawReport& report, const WriteSolve& write_solve) {
  JsonWriter json;
  json.begin_object();
  write_solve(json);
  write_checks(json, report);
  return json.end_object().text() + "\n";
}

Answer check_decomposition(const DecompositionProblem& problem, const Problem& file_content,
                           const std::string& file, const CheckOptions& options) {
  require_applicable(file_content.solve, options);
  const SplitPoint split = split_point(problem, file_content.solve, options);
  const convex::Function f = convex::make_function(problem.f, {problem.W});
  const convex::LawReport report = convex::laws(f, {problem.z}, {{"given", problem.W}});
  return {exit_code(report, split.split.status),
          options.json ? with_checks(report, [&](JsonWriter& json) { write_split(json, split, file); })
                       : heading(file_content.title, file) + split_text(split) + "\n" + checks_text(report)};
}

Answer check_cone(const ConeProblem& problem, const Problem& file_content, const std::string& file,
                  const CheckOptions& options) {
  require_cone_settings(file_content.solve, options);
  const SolvedCone solved = solve_cone(problem);
  const convex::LawReport report =
      solved.split ? convex::cone_laws(solved.cone, solved.polar, problem.W, *problem.z, *solved.split)
                   : convex::cone_laws(solved.cone, solved.polar, problem.W);
  return {exit_code(report, convex::Status::solved),
          options.json ? with_checks(report, [&](JsonWriter& json) { write_cone(json, solved, file); })
                       : heading(file_content.title, file) + cone_text(solved) + "\n" + checks_text(report)};
}

Answer check_scene(Scene scene, const CheckOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  mechanics::GaussSolution solution;
  std::vector<mechanics::Warning> warnings =
      resolve_scene(scene, [&](const Scene& attempt) -> const mechanics::GaussSolution& {
        return solution = solve_plainly(attempt, attempt.solve);
      });
  if (auto violated = violated_at_higher_order(scene, solution)) warnings.push_back(*std::move(violated));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::optional<double> as_evaluated = settle_evaluation_error(scene, solution);
  const convex::LawReport report =
      mechanics::gauss_laws(solution.data ? *solution.data : scene.problem, solution, scene.solve);
  SolvedScene solved = solved_scene(scene, solution, seconds);
  solved.as_evaluated = as_evaluated;
  solved.warnings = std::move(warnings);
  add_contact_warnings(solved);
  return {exit_code(report, solution.primal.status),
          options.json ? with_checks(report, [&](JsonWriter& json) { write_solved(json, solved); })
                       : solve_text(solved) + "\n" + checks_text(report),
          warning_lines(solved)};
}

Answer check_file(const std::string& file, const CheckOptions& options) {
  Problem problem = read_problem_file(file, options);
  if (const auto* decomposition = std::get_if<DecompositionProblem>(&problem.content))
    return check_decomposition(*decomposition, problem, file, options);
  if (const auto* cone = std::get_if<ConeProblem>(&problem.content))
    return check_cone(*cone, problem, file, options);
  if (std::holds_alternative<LiquidProblem>(problem.content))
    throw convex::InvalidInput(
        "check puts the answers of [system], [projection], [decomposition] and [cone] to their laws; a "
        "liquid's is "
        "proved by `moreau solve --certify`");
  return check_scene(make_scene(std::move(problem), file, options), options);
}

Exit check_files(const CheckOptions& options) {
  return print_for_each_file(options, [&](const std::string& file) { return check_file(file, options); });
}

}  // namespace

void add_check(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App& command = add_command(
      program, "check",
      "the decomposition theorem, numerically: laws that the answer must obey, each with its bound", chosen,
      [options] {
        if (options->map.is_given()) return check_map(options->map, *options);
        if (!options->catalogue) return check_files(*options);
        return options->certify ? prove_catalogue(*options) : check_catalogue(*options);
      });
  CLI::Option* files = command.add_option("FILE", options->files, "problem files; - is standard input");
  CLI::Option* catalogue =
      command
          .add_flag("--catalogue", options->catalogue, "every set, function and operation, in four metrics")
          ->excludes(files);
  command
      .add_flag("--certify", options->certify,
                "with --catalogue: which examples are proved, to how many digits; exit 3 unless all are")
      ->needs(catalogue);
  add_map(command, options->map);
  add_accuracy(command, *options);
  add_overrides(command, *options);
  add_printing(command, *options);
  command.parse_complete_callback([options] {
    const int asked = int{!options->files.empty()} + int{options->catalogue} +
                      int{options->map.map.has_value()} + int{options->map.table.has_value()};
    if (asked == 0) throw CLI::RequiredError("FILE, --catalogue or --map");
    if (asked > 1) throw CLI::ValidationError("FILE, --catalogue, --map and --table go one at a time");
    if (!options->settings.empty() && options->files.empty())
      throw CLI::ValidationError("--set changes what a file says; give a FILE");
    if (const char* advice = options->map.given_amiss()) throw CLI::ValidationError(advice);
  });
}

}  // namespace cli::inline commands
