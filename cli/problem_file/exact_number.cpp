#include "cli/problem_file/exact_number.hpp"

#include <algorithm>
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

bool is_double(const TomlValue& value) {
  if (value.kind == TomlValue::Kind::array)
    return std::all_of(value.array.begin(), value.array.end(), is_double);
  const bool is_long =
      value.kind == TomlValue::Kind::integer && std::abs(value.number) >= first_gap_of_integers;
  if (!is_long && !value.is_string()) return true;
  const auto meant = convex::read_fraction(value.text);
  if (!meant) return true;  // no number: others say so
  const double number = convex::nearest_double(*meant);
  return std::isfinite(number) && convex::fraction(number) == *meant;
}

void require_doubles(const TomlValue& value, const std::string& where, const std::string& form) {
  for (const TomlValue& entry : value.array) require_doubles(entry, where, form);
  for (const TomlEntry& entry : value.table) require_doubles(entry.value, where, form);
  if (is_double(value)) return;
  const std::string quote = value.is_string() ? "\"" : "";
  throw convex::InvalidInput(where + ": " + quote + value.text + quote + " is no double, and " + form +
                                 " has doubles alone; write the one that is meant",
                             value.place);
}

}  // namespace cli::inline problem_files
