#include "cli/problem_file/exact_number.hpp"

#include <cmath>

#include "convex/exact/fraction.hpp"
#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/invalid_input.hpp"

namespace cli::inline problem_files {

std::optional<double> nearest_double(const std::string& text) {
  const auto value = convex::read_fraction(text);
  if (!value) return std::nullopt;
  return convex::nearest_double(*value);
}

void require_doubles(const TomlValue& value, const std::string& where, const std::string& form) {
  for (const TomlValue& entry : value.array) require_doubles(entry, where, form);
  for (const TomlEntry& entry : value.table) require_doubles(entry.value, where, form);
  if (!value.is_string()) return;
  const auto meant = convex::read_fraction(value.text);
  if (!meant) return;
  const double number = convex::nearest_double(*meant);
  if (std::isfinite(number) && convex::fraction(number) == *meant) return;
  throw convex::InvalidInput(where + ": \"" + value.text + "\" is no double, and " + form +
                                 " has doubles alone; write the one that is meant",
                             value.place);
}

}  // namespace cli::inline problem_files
