#pragma once

#include "cli/report/solve_report.hpp"

namespace cli::inline reports {

/// The keys `warnings` and, where equations were added, `added_rows`.
void write_warnings(JsonWriter&, const SolvedScene&);
void write_added_rows(JsonWriter&, const SolvedScene&);

/// The equations that were added, and the contacts that only touch, in words; "" without.
std::string added_rows_text(const SolvedScene&);
std::string touching_text(const SolvedScene&);

/// The warnings as lines for standard error.
std::vector<std::string> warning_lines(const SolvedScene&);

}  // namespace cli::inline reports
