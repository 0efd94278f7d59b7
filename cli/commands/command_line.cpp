#include "cli/commands/command_line.hpp"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdlib>

namespace cli::inline commands {

CLI::App& add_command(CLI::App& program, const char* name, const char* help, Work& chosen, Work work) {
  CLI::App& command = *program.add_subcommand(name, help);
  command.callback([&chosen, work = std::move(work)] { chosen = work; });
  return command;
}

void add_printing(CLI::App& command, Printing& printing) {
  command.add_flag("--json", printing.json, "one JSON object per file, one per line, on standard output");
  command.add_flag("--quiet", printing.quiet, "no text; the exit code tells");
}

void add_overrides(CLI::App& command, Overrides& options) {
  command
      .add_option("--set", options.settings,
                  "what the file says, said otherwise: \"m=3\", \"position.x=0.2\", \"simulate.until=2\"")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_files(CLI::App& command, FileOptions& options) {
  command.add_option("FILE", options.files, "problem files; - is standard input")->required();
  add_overrides(command, options);
  add_printing(command, options);
}

std::string positive_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() && *end == '\0' && std::isfinite(value) && value > 0) return "";
  return text + " is not a positive number; give one above 0";
}

std::string nonnegative_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() && *end == '\0' && std::isfinite(value) && value >= 0) return "";
  return text + " is not a number from 0 on; give 0 or more";
}

std::string name_of_numbers(const std::string& file) {
  for (const char* ending : {".svg", ".png", ".pdf", ".html", ".htm"})
    if (file.ends_with(ending))
      return file + " is the name of a picture or a page, and numbers are written here; name a table, F.csv";
  return "";
}

void add_table(CLI::App& command, const char* option, std::optional<std::string>& file, const char* help) {
  command.add_option(option, file, help)->type_name("F.csv")->check(name_of_numbers);
}

void add_accuracy(CLI::App& command, AccuracyOptions& options, const char* tolerance, const char* method) {
  command.add_option("--method", options.method, method)->type_name("NAME");
  command.add_option("--tolerance", options.tolerance, tolerance)->type_name("X")->check(positive_number);
  command
      .add_option(
          "--limit", options.limit,
          "let fractions take N times their usual share (some seconds) where doubles cannot decide; 0: never")
      ->type_name("N")
      ->check(nonnegative_number);
}

void add_step_tolerance(CLI::App& command, MotionChoice& options) {
  command.add_option("--tolerance", options.tolerance, "error of a step; default 1e-10")
      ->type_name("X")
      ->check(positive_number);
}

void add_function(CLI::App& command, FunctionOptions& options, bool needs_point) {
  command
      .add_option("f", options.expression,
                  "a function of the call language, such as \"norm1(weight=2)\" (see `moreau functions`)")
      ->required();
  command
      .add_option("--at", options.at,
                  needs_point ? "a point, such as \"[3, -1, 1/2]\"; or @F.csv: one a line of that file"
                              : "a point, such as \"[3, -1, 1/2]\"")
      ->type_name("VECTOR");
  command
      .add_option(
          "--metric", options.metric,
          "the Gram matrix W of (x|y) = x.Wy: \"[[2, 1], [1, 2]]\", or \"diagonal [1, 2]\"; default identity")
      ->type_name("MATRIX");
  if (needs_point)
    command.parse_complete_callback([&options] {
      if (!options.at && !options.symbolic) throw CLI::RequiredError("--at");
    });
}

void add_symbols(CLI::App& command, FunctionOptions& options) {
  CLI::Option* symbolic = command.add_flag("--symbolic", options.symbolic,
                                           "of one variable: the whole function, exactly, by cases");
  command.add_flag("--latex", options.latex, "with --symbolic: formulas for amsmath")->needs(symbolic);
}

void add_proof(CLI::App& command, bool& certify) {
  command.add_flag("--certify", certify, "a proved error bound; exit 3 without proof");
}

void add_measurement(CLI::App& command, MeasurementOptions& options, const char* columns) {
  command.add_option("--method", options.method, "this method alone")->type_name("NAME");
  command.add_option("--output", options.output, "the picture: F.svg, F.png or F.pdf (drawn by gnuplot)")
      ->type_name("FILE");
  add_table(command, "--data", options.data, columns);
  command.add_flag("--quick", options.quick, "fewer and smaller problems, half a minute at most");
  command.add_flag("--quiet", options.quiet, "no text");
}

}  // namespace cli::inline commands
