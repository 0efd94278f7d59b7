#pragma once

#include <string>

#include "cli/options.hpp"
#include "convex/nearest_point/solution.hpp"

namespace cli {

/// What a command prints on standard output, as text or as a line of JSON, and its exit code.
struct Answer {
  Exit exit = Exit::solved;
  std::string text;
};

/// The exit code that goes with a status.
Exit exit_code(convex::Status);

/// "solved", "inaccurate", "infeasible", "gave-up".
const char* name(convex::Status);

/// What a readable result begins with: the title, if there is one, and the file.
std::string heading(const std::string& title, const std::string& file);

}  // namespace cli
