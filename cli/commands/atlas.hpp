#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "cli/problem_file/problem.hpp"
#include "cli/report/answer.hpp"

namespace cli::inline commands {

/// What `moreau atlas` is told.
struct AtlasOptions : FileOptions {
  std::optional<std::string> mean, covariance;  ///< of the force
  double tolerance = 1e-6;                      ///< of each probability
  std::vector<std::string> over;                ///< forces, of a map
  std::optional<std::size_t> cells;             ///< so many are explored from the file's force
  std::optional<std::string> plot;
};

/// The atlas of a [system] or [projection], drawn where that is asked for; `file` is what it was read from.
/// Throws InvalidInput.
Answer atlas_of_problem(Problem problem, const std::string& file, const AtlasOptions& options);

}  // namespace cli::inline commands
