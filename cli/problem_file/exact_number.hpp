#pragma once

#include <optional>
#include <string>

#include "cli/problem_file/toml_document.hpp"

namespace cli::inline problem_files {

/// The double nearest to an exact value written as "p/q", an integer or a decimal ("1/3", "-2", "0.1",
/// "1e-3"); infinite when it
/// is beyond all doubles; none when the text is not a number or the denominator is 0.
std::optional<double> nearest_double(const std::string& text);

/// Throws InvalidInput where a number in quotes, in a list or lists of them, is no double: files of this form
/// have doubles alone.
void require_doubles(const TomlValue& value, const std::string& where, const std::string& form);

}  // namespace cli::inline problem_files
