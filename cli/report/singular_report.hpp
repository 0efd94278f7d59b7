#pragma once

#include "cli/report/solve_report.hpp"

namespace cli::inline reports {

/// The keys `warnings` and, where equations were added, `added_rows`: without an answer without multipliers.
void write_warnings(JsonWriter&, const SolvedScene&);
void write_added_rows(JsonWriter&, const SolvedScene&);
void write_added_rows(JsonWriter&, const Scene&);

/// The equations that were added, and the contacts that only touch, in words; "" without.
std::string added_rows_text(const SolvedScene&);
std::string touching_text(const SolvedScene&);

/// "Added row 1 ...: the sum of 24 a'' and -24 b'' is 0" and where it comes from.
std::string added_row_text(const Scene&, std::size_t added);

/// The warnings as lines for standard error.
std::vector<std::string> warning_lines(const SolvedScene&);
std::vector<std::string> warning_lines(const std::vector<mechanics::Warning>&);

}  // namespace cli::inline reports
