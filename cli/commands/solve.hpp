#pragma once

#include <optional>
#include <string>

#include "cli/commands/liquid_report.hpp"
#include "cli/options.hpp"
#include "cli/problem_file/problem.hpp"
#include "cli/report/answer.hpp"

namespace cli::inline commands {

/// What `moreau solve` is told.
struct SolveOptions : FileOptions, SceneOptions {
  bool sensitivity = false;
  bool verbose = false;              ///< how the answer was found
  bool null_space = false;           ///< of the multipliers, in JSON
  bool certify = false;              ///< a proved error bound, or that there is no solution
  std::optional<std::string> plot;   ///< a picture to write
  std::optional<std::string> plane;  ///< its two coordinates
  LiquidRequest liquid;
};

/// Solves a problem of any kind, draws and writes what is asked for; `file` is what it was read from. Throws
/// InvalidInput.
Answer solve_problem(Problem problem, const std::string& file, const SolveOptions& options);

}  // namespace cli::inline commands
