#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cli {

/// Exit codes of the program (docs/commands.md).
enum class Exit { solved = 0, no_solution = 1, wrong_input = 2, inaccurate = 3 };

/// What the command line says, for every command.
struct Options {
  std::vector<std::string> files;
  std::optional<std::string> method;
  std::optional<double> tolerance;
  std::optional<double> limit;  ///< of fractions, where doubles leave a decision open
  bool json = false;
  bool quiet = false;
  bool ranges = false;
  bool full_model = false;  ///< solve without islands, special structure and leaving out
  bool catalogue = false;   ///< of check: the whole language instead of files
  bool sensitivity = false;
  bool null_space = false;                 ///< of the multipliers, in JSON
  bool certify = false;                    ///< a proved error bound, or that there is no solution
  std::string expression;                  ///< of prox and conjugate: a call of the language of functions
  std::optional<std::string> at;           ///< a vector
  std::optional<std::string> metric;       ///< a matrix, or "diagonal [1, 2]"
  std::optional<std::string> function;     ///< of functions: the one to tell about
  std::optional<std::string> family;       ///< of gallery
  std::optional<double> difficulty;        ///< of gallery: the setting of the family's knob
  std::optional<long> size;                ///< of gallery
  unsigned seed = 1;                       ///< of gallery
  std::optional<std::string> output;       ///< a file to write
  bool markdown = false;                   ///< of functions: docs/functions.md
  std::optional<std::string> plot;         ///< of solve: a picture to write
  std::optional<double> until;             ///< of simulate
  std::optional<std::string> period;       ///< of orbit: an expression in the parameters, or "free"
  long periods = 1;                        ///< of orbit
  std::optional<std::string> over;         ///< of orbit: "w=1:0.01:3"
  std::vector<std::string> modulo;         ///< of orbit: "a=2*pi"
  bool impact_laws = false;                ///< of simulate: all laws at the first impact
  std::optional<std::string> events;       ///< of simulate: a file to write
  std::optional<long> step_limit;          ///< of simulate
  std::optional<std::string> data;         ///< of chart and stress: a table file to write
  std::optional<std::string> relative_to;  ///< of chart: the method whose times are the unit
  std::string error = "acceleration";      ///< of chart: what the error is of
  bool profile = false;                    ///< of chart
  std::vector<std::string> families;       ///< of stress
  bool quick = false;                      ///< of chart and stress: fewer problems, settings and repetitions
  bool peers = false;                      ///< of stress: with the solvers of other packages
  bool polish = false;                     ///< of stress: answers after the judge's refinement
};

}  // namespace cli
