#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <fstream>

#include "cli/commands/command_line.hpp"
#include "cli/commands/liquid_report.hpp"
#include "cli/each_file.hpp"
#include "cli/motion_settings.hpp"
#include "cli/report/cone_report.hpp"
#include "cli/report/decomposition_report.hpp"
#include "cli/report/explanation.hpp"
#include "cli/report/singular_report.hpp"
#include "cli/resolved_scene.hpp"

namespace cli::inline commands {
namespace {

using convex::InvalidInput;

/// What `moreau explain` is told.
struct ExplainOptions : FileOptions, SceneOptions {
  bool markdown = false, latex = false, html = false;
  std::optional<std::string> output;  ///< a file to write
};

/// In the form that is asked for, else in that of the file's ending.
std::string written(const Document& document, const ExplainOptions& options) {
  const bool is_asked = options.latex || options.html || options.markdown;
  const auto is_of = [&](bool asked, std::initializer_list<const char*> endings) {
    const auto ends = [&](const char* ending) { return options.output && options.output->ends_with(ending); };
    return asked || (!is_asked && std::any_of(endings.begin(), endings.end(), ends));
  };
  if (is_of(options.latex, {".tex"})) return document_latex(document);
  if (is_of(options.html, {".html", ".htm"})) return document_html(document);
  if (is_of(options.markdown, {".md"})) return document_markdown(document);
  return document_text(document);
}

/// What stands between two spaces or more.
std::vector<Line> cells(const std::string& line) {
  std::vector<Line> found;
  for (std::size_t at = line.find_first_not_of(' '); at < line.size(); at = line.find_first_not_of(' ', at)) {
    const std::size_t end = std::min(line.find("  ", at), line.size());
    found.push_back({line.substr(at, end - at)});
    at = end;
  }
  return found;
}

/// Lines that are columns below a head, which may have none above the first; nothing if they are not.
std::optional<Table> table_of(const std::vector<std::string>& lines) {
  if (lines.size() < 2) return std::nullopt;
  Table table{cells(lines.front()), {}};
  for (std::size_t k = 1; k < lines.size(); ++k) table.rows.push_back(cells(lines[k]));
  const std::size_t width = table.rows.front().size();
  if (table.head.size() + 1 == width) table.head.insert(table.head.begin(), Line{});
  const auto fits = [&](const std::vector<Line>& row) { return row.size() == width; };
  return width > 1 && fits(table.head) && std::all_of(table.rows.begin(), table.rows.end(), fits)
             ? std::optional(table)
             : std::nullopt;
}

/// Lines of columns below a line that is their title make a table, each other line a paragraph.
void add_titled_tables(const std::vector<std::string>& lines, std::vector<Block>& blocks) {
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::size_t width = k + 1 < lines.size() ? cells(lines[k + 1]).size() : 0;
    if (width < 2 || cells(lines[k]).size() != 1) {
      blocks.emplace_back(Paragraph{{lines[k]}});
      continue;
    }
    Table table{cells(lines[k]), {}};
    table.head.resize(width);
    for (; k + 1 < lines.size() && cells(lines[k + 1]).size() == width; ++k)
      table.rows.push_back(cells(lines[k + 1]));
    blocks.emplace_back(std::move(table));
  }
}

/// A report that is text already: what stands between two empty lines is a table, titled tables, or
/// paragraphs.
Document document_of_lines(const std::string& title, const std::string& text) {
  Document document{title, {}};
  std::vector<std::string> lines;
  const auto close = [&] {
    if (auto table = table_of(lines))
      document.blocks.emplace_back(std::move(*table));
    else
      add_titled_tables(lines, document.blocks);
    lines.clear();
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (end > at)
      lines.push_back(text.substr(at, end - at));
    else
      close();
    at = end + 1;
  }
  close();
  return document;
}

/// A report with its exit code and warnings.
struct Explained {
  Exit exit = Exit::solved;
  Document document;
  std::vector<std::string> warnings = {};
};

Explained explain_scene(Problem problem, const std::string& file, const ExplainOptions& options) {
  std::optional<SystemProblem> text;
  if (const auto* system = std::get_if<SystemProblem>(&problem.content)) text = *system;
  const SolveSettings solve = problem.solve;
  const Problem kept = problem;
  Scene scene = make_scene(std::move(problem), file, options);
  ProvedScene resolved = resolve_and_prove(scene, false);
  mechanics::GaussSolution& solution = resolved.found.solution;
  const std::optional<double> as_evaluated =
      scene.written ? settle_evaluation_error(scene, solution) : std::nullopt;
  SolvedScene solved = solved_scene(scene, solution, 0);
  solved.as_evaluated = as_evaluated;
  solved.warnings = std::move(resolved.warnings);
  add_contact_warnings(solved);
  Line next;
  if (text && scene.added.empty() && solved.has_answer())
    next = next_event(scene, motion_options(kept, *scene.system, {}));
  return {exit_code(solution.primal.status), explanation(solved, text ? &*text : nullptr, next),
          warning_lines(solved)};
}

Explained explained(const std::string& file, const ExplainOptions& options) {
  Problem problem = read_problem_file(file, options);
  const std::string title = problem.title.empty() ? file : problem.title;
  if (const auto* decomposition = std::get_if<DecompositionProblem>(&problem.content)) {
    const SplitPoint split = split_point(*decomposition, problem.solve, options);
    return {exit_code(split.split.status), document_of_lines(title, split_text(split))};
  }
  if (const auto* liquid = std::get_if<LiquidProblem>(&problem.content)) {
    LiquidRequest request;
    request.tolerance = problem.solve.tolerance;
    const SolvedLiquid solved = solve_liquid_text(liquid->text, request);
    return {solved.exit(), document_of_lines(title, liquid_text(solved))};
  }
  if (const auto* cone = std::get_if<ConeProblem>(&problem.content))
    return {Exit::solved, document_of_lines(title, cone_text(solve_cone(*cone)))};
  return explain_scene(std::move(problem), file, options);
}

Answer explain_file(const std::string& file, const ExplainOptions& options) {
  Explained made = explained(file, options);
  const std::string text = written(made.document, options);
  if (!options.output) return {made.exit, text, std::move(made.warnings)};
  std::ofstream out(*options.output, std::ios::binary);
  if (!(out << text) || !out.flush())
    throw InvalidInput("-o " + *options.output +
                       ": cannot be written; name a file in a folder that there is");
  return {made.exit, "", std::move(made.warnings)};
}

Exit explain_files(const ExplainOptions& options) {
  const auto refused = [&](const char* why) {
    return answered(options, {options.files.front(), ""}, [&]() -> Exit { throw InvalidInput(why); });
  };
  if (options.output && options.files.size() > 1)
    return refused("-o takes one problem file; run the files one by one");
  if (options.markdown + options.latex + options.html > 1)
    return refused("--markdown, --latex and --html are three ways to write; give one of them");
  return print_for_each_file(options, [&](const std::string& file) { return explain_file(file, options); });
}

}  // namespace

void add_explain(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<ExplainOptions>();
  CLI::App& command =
      add_command(program, "explain", "the reasoning behind an answer, step by step, on its numbers", chosen,
                  [options] { return explain_files(*options); });
  command.add_option("FILE", options->files, "problem files; - is standard input")->required();
  add_overrides(command, *options);
  command.add_flag("--quiet", options->quiet, "no text; the exit code tells");
  command.add_flag("--markdown", options->markdown, "as Markdown, formulas between dollars");
  command.add_flag("--latex", options->latex, "as a LaTeX file");
  command.add_flag("--html", options->html, "as one HTML file");
  command
      .add_option("-o,--output", options->output,
                  "the file to write; its ending .md, .tex or .html tells the form")
      ->type_name("F");
}

}  // namespace cli::inline commands
