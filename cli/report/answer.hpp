#pragma once

#include <string>
#include <vector>

#include "cli/options.hpp"
#include "convex/nearest_point/proof/certificate.hpp"
#include "convex/nearest_point/solution.hpp"

namespace cli::inline reports {

/// What a command prints on standard output, as text or as a line of JSON, its exit code, and what it has to
/// say of the answer on standard error.
struct Answer {
  Exit exit = Exit::solved;
  std::string text;
  std::vector<std::string> warnings = {};
};

/// The exit code that goes with a status.
Exit exit_code(convex::Status);

/// "solved", "inaccurate", "infeasible", "gave-up".
const char* name(convex::Status);

/// "none", "enclosure", "exact".
const char* name(convex::ProofLevel);

/// What a readable result begins with: the title, if there is one, and the file.
std::string heading(const std::string& title, const std::string& file);

}  // namespace cli::inline reports
