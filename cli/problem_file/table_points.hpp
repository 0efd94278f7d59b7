#pragma once

#include <string>
#include <vector>

#include "mechanics/lagrangian_text.hpp"

namespace cli::inline problem_files {

/// The words of a line of a table: between semicolons, else commas, else blanks and tabs. An empty one is
/// one.
std::vector<std::string> table_cells(const std::string& line);

/// The points of table(x, "F.csv"): two columns; a first line without a number is a heading, lines that begin
/// with # are comments. Throws InvalidInput with the line.
mechanics::TablePoints read_table_points(const std::string& file);

}  // namespace cli::inline problem_files
