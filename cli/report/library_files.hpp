#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/measurement/problem_library.hpp"

namespace cli::inline reports {

/// Writes problems with their truth (docs/problem-library.md) below a folder: CLASS/NAME.toml, .json,
/// .truth.json and the folder NAME of Matrix Market files, and the index, index.csv. `done` hears of each.
/// Returns how many were written; what has no exact truth is told to `left_out`.
std::size_t write_library(const std::vector<LibraryProblem>& problems, const std::string& folder,
                          const std::function<void(const std::string& name)>& done,
                          const std::function<void(const std::string& why)>& left_out);

}  // namespace cli::inline reports
