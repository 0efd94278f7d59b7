#pragma once

#include <string>

#include "mechanics/lagrangian_text.hpp"

namespace cli::inline problem_files {

/// The points of table(x, "F.csv"): two columns, by commas, semicolons, tabs or spaces; a first line that is
/// no numbers is a heading, lines that begin with # are comments. Throws InvalidInput with the line.
mechanics::TablePoints read_table_points(const std::string& file);

}  // namespace cli::inline problem_files
