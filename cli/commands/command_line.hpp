#pragma once

#include <functional>
#include <string>

#include "cli/options.hpp"

namespace CLI {
class App;
}

namespace cli::inline commands {

/// What the program is to do, once its command line is read.
using Work = std::function<Exit()>;

// Each command adds itself to the program, with its options; when it is the one called, its work goes to
// `chosen`. One file a command, read as its help text.

void add_solve(CLI::App& program, Work& chosen);
void add_check(CLI::App& program, Work& chosen);
void add_derive(CLI::App& program, Work& chosen);
void add_explain(CLI::App& program, Work& chosen);
void add_simulate(CLI::App& program, Work& chosen);
void add_orbit(CLI::App& program, Work& chosen);
void add_prox(CLI::App& program, Work& chosen);
void add_conjugate(CLI::App& program, Work& chosen);
void add_subdifferential(CLI::App& program, Work& chosen);
void add_functions(CLI::App& program, Work& chosen);
void add_methods(CLI::App& program, Work& chosen);
void add_gallery(CLI::App& program, Work& chosen);
void add_chart(CLI::App& program, Work& chosen);
void add_stress(CLI::App& program, Work& chosen);
void add_assemble(CLI::App& program, Work& chosen);
void add_sweep(CLI::App& program, Work& chosen);
void add_atlas(CLI::App& program, Work& chosen);
void add_convert(CLI::App& program, Work& chosen);
void add_schema(CLI::App& program, Work& chosen);
void add_new(CLI::App& program, Work& chosen);
void add_help(CLI::App& program, Work& chosen);
void add_completions(CLI::App& program, Work& chosen);

/// `moreau check --catalogue`: the laws over every set, function and operation of the language.
Exit check_catalogue(const Printing&);
/// `moreau check --catalogue --certify`: which examples of the language are proved, to how many digits.
Exit prove_catalogue(const Printing&);

// What several commands have.

/// A command of this name; `work` is chosen when it is called.
CLI::App& add_command(CLI::App& program, const char* name, const char* help, Work& chosen, Work work);

/// --json and --quiet.
void add_printing(CLI::App& command, Printing&);

/// --set.
void add_overrides(CLI::App& command, Overrides&);

/// Problem files, what is set in them, and how their answers are printed.
void add_files(CLI::App& command, FileOptions&);

/// --method, --tolerance, with what it is a tolerance of, and --limit.
inline constexpr const char* tolerance_of_solutions =
    "accept an error bound of X * max(1, ||q''||_A), default 1e-9; of a liquid of X times the largest "
    "pressure, default 1e-3";
inline constexpr const char* method_of_solutions = "method of solution (see `moreau methods`)";
inline constexpr const char* method_of_functions =
    "exact: in fractions, of what is piecewise linear-quadratic";
void add_accuracy(CLI::App& command, AccuracyOptions&, const char* tolerance = tolerance_of_solutions,
                  const char* method = method_of_solutions);

/// --tolerance of a motion's steps.
void add_step_tolerance(CLI::App& command, MotionChoice&);

/// Of the text of an option: "", or what is wrong with it.
std::string positive_number(const std::string& text);
std::string nonnegative_number(const std::string& text);
/// Refuses the name of a picture or a page for a file of numbers.
std::string name_of_numbers(const std::string& file);
/// An option that names a table to write.
void add_table(CLI::App& command, const char* option, std::optional<std::string>& file, const char* help);

/// A function with a point and a metric, as `prox` and `conjugate` are asked for.
struct FunctionOptions : Printing, AccuracyOptions {
  std::string expression;             ///< a call of the language of functions
  std::optional<std::string> at;      ///< a vector
  std::optional<std::string> metric;  ///< a matrix, or "diagonal [1, 2]"
  bool certify = false;               ///< a proved error bound
  bool symbolic = false;              ///< the whole function of one variable, by cases
  bool latex = false;                 ///< these as formulas
};
void add_function(CLI::App& command, FunctionOptions&, bool needs_point);
/// --symbolic and --latex.
void add_symbols(CLI::App& command, FunctionOptions&);

/// --certify.
void add_proof(CLI::App& command, bool& certify);

/// A measurement with its picture and its table.
struct MeasurementOptions : Printing {
  std::optional<std::string> method;  ///< this one alone
  std::optional<std::string> output, data;
  bool quick = false;  ///< fewer problems, settings and repetitions
};
void add_measurement(CLI::App& command, MeasurementOptions&, const char* columns);

}  // namespace cli::inline commands
