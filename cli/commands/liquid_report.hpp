#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "cli/problem_file/problem.hpp"
#include "mechanics/liquid/liquid_solution.hpp"
#include "mechanics/liquid/onset.hpp"

namespace cli::inline commands {

/// What is asked of a liquid beside its pressure.
struct LiquidRequest {
  std::vector<std::string> probes;             ///< points, "x=0.3, y=0"
  std::optional<std::string> onset;            ///< a parameter
  std::optional<std::string> data, vtk, plot;  ///< files to write
  bool velocity = false;                       ///< as arrows in the plot
  std::optional<std::string> plane;            ///< of three dimensions, what the plot shows
  std::optional<std::string> animate, over;    ///< a page to write, and NAME=first:step:last of a parameter
  std::string title;                           ///< of the page
  std::optional<double> tolerance;
  bool certify = false;
};

/// A liquid with its pressure, and the answers to what was asked.
struct SolvedLiquid {
  mechanics::liquid::LiquidScene scene;
  mechanics::liquid::LiquidSolution solution;
  std::vector<mechanics::liquid::LiquidProbe> probes;
  std::optional<std::string> onset_of;
  mechanics::liquid::OnsetSearch onset;
  std::string level = "estimate";  ///< of the certificate
  double asked = 0;                ///< the error asked for, as a part of the largest pressure
  double seconds = 0;

  Exit exit() const;
};

/// Throws InvalidInput when a setting of the file or an option means nothing for a liquid.
void require_liquid_settings(const SolveSettings&, const AccuracyOptions&);
/// Throws InvalidInput when something is asked that only a liquid has.
void require_no_liquid_request(const LiquidRequest&);

/// Solves, and writes the files asked for.
SolvedLiquid solve_liquid_text(const mechanics::liquid::LiquidText&, const LiquidRequest&);

/// The object of docs/liquid.md, one line without its end.
std::string liquid_json(const SolvedLiquid&, const std::string& file);

/// The readable result below a heading.
/// What is said on standard error too: parts of no boundary point.
std::vector<std::string> liquid_warnings(const SolvedLiquid&);

std::string liquid_text(const SolvedLiquid&);

}  // namespace cli::inline commands
