#pragma once

#include <string>
#include <string_view>

#include "convex/invalid_input.hpp"

namespace cli::inline problem_files {

/// What is wrong with a text that is no TOML and what to write instead, "…; …", for the slips that are made
/// most: two keys on a line, a colon for an equals sign, an expression without quotation marks, a unit behind
/// a number. `description` is what the parser found wrong at the place. "" where it is none of these.
std::string advice_on_slip(const std::string& text, convex::Place place, std::string_view description);

}  // namespace cli::inline problem_files
