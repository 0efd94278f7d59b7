#pragma once

#include <string>
#include <vector>

#include "cli/problem_file/toml_document.hpp"

namespace cli::inline problem_files {

/// `--set KEY=VALUE`: what a problem file says, said otherwise. KEY is a parameter, "position.x",
/// "velocity.x", "t", or a path such as "simulate.until" and "state.position.x"; VALUE a number, an
/// expression or a value of TOML.
struct Setting {
  std::string key;
  TomlValue value;
  std::string option = "--set";  ///< that it came from, for messages
};

/// Throws InvalidInput for what has not this form.
Setting parse_setting(const std::string& text);

std::vector<Setting> parsed_settings(const std::vector<std::string>& texts);

/// Puts the values in their places. Throws InvalidInput for a parameter that the file does not have.
void apply_settings(TomlValue& document, const std::vector<Setting>& settings);

/// The same for one number of `--over`, written with all its digits.
Setting number_setting(const std::string& key, double value);

}  // namespace cli::inline problem_files
