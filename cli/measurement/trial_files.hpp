#pragma once

#include <string>
#include <vector>

#include "cli/measurement/trial.hpp"

namespace cli::inline measurement {

/// The columns of `chart --data`: problem, n, m, method, setting, seconds, error, status.
std::string chart_csv(const std::vector<Trial>&);

/// A trial of the stress map: the family that the problem came from, and how hard it was made.
struct StressTrial {
  std::string family, knob;
  double difficulty = 0;
  Trial trial;
};

/// The columns of `stress --data`: family, difficulty, n, m, method, seconds, error, status.
std::string stress_csv(const std::vector<StressTrial>&);

/// What a table of trials cannot say, as JSON: the machine, how times were taken, and for each row of the
/// table the quartiles, the repetitions, the error of the multipliers and the bound that the method gave.
std::string measurement_json(const std::vector<Trial>&, const TrialLimits&);

/// F.csv -> F.about.json.
std::string about_file(const std::string& data_file);

}  // namespace cli::inline measurement
