#pragma once

#include <string>

#include "cli/report/solve_report.hpp"

namespace cli::inline reports {

/// What the classical hypothesis and the rule "drop the negative ones" would have said, in words.
std::string hypothesis_text(const SolvedScene&);

/// Whether it is solved, and how far the acceleration may be off, of what: a line.
std::string accuracy_text(const SolvedScene&);

/// "a", "a and b", "a, b and c"; a long list is cut and counted.
std::string listed(const std::vector<std::string>& names);

}  // namespace cli::inline reports
