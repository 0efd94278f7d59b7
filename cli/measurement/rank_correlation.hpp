#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/measurement/trial.hpp"

namespace cli::inline measurement {

/// How alike two measurements order the methods of a problem, best first.
struct RankCorrelation {
  std::string problem;
  double value = 0;  ///< Spearman's rho (1904), equal ranks being averaged: 1 is the same order
};

/// For each problem that both have in the same size, methods being ranked by their least time to an error of
/// 1e-9; those that do not get there share the last place.
std::vector<RankCorrelation> rank_correlations(const std::vector<Trial>&, const std::vector<Trial>& before);

/// The trials of a table that `chart --data` wrote, as far as it tells. Throws InvalidInput when it is none.
std::vector<Trial> read_chart_csv(const std::string& file);

/// docs/charts/speed_accuracy.csv beside the program's build folder or here, where it is.
std::optional<std::string> committed_data();

}  // namespace cli::inline measurement
