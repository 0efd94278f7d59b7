#pragma once

#include <optional>
#include <string>

#include "cli/problem_file/toml_document.hpp"

namespace cli::inline problem_files {

/// The double nearest to an exact value written as "p/q", an integer or a decimal ("1/3", "-2", "0.1",
/// "1e-3"); infinite when it
/// is beyond all doubles; none when the text is not a number or the denominator is 0.
std::optional<double> nearest_double(const std::string& text);

/// Below, all integers are doubles.
constexpr double first_gap_of_integers = 0x1p53;

/// Whether each number of a value, or of a list or lists, is the double that is read for it: an integer
/// beyond 2^53 may be none, nor what stands in quotation marks.
bool is_double(const TomlValue& value);

/// Throws InvalidInput where a number of a list or lists is no double: files of this form have doubles alone.
void require_doubles(const TomlValue& value, const std::string& where, const std::string& form);

}  // namespace cli::inline problem_files
