#include "cli/problem_file/numbers.hpp"

#include <charconv>

#include "cli/problem_file/keys.hpp"
#include "convex/invariant.hpp"

namespace cli::inline problem_files {

using convex::Index;
using convex::InvalidInput;
using convex::Vector;

namespace {

void require_entries(const TomlValue& row, const std::string& where, Index found, Index wanted,
                     const std::string& why) {
  if (found == wanted) return;
  throw InvalidInput(where + ": " + std::to_string(found) + (found == 1 ? " entry" : " entries") + "; give " +
                         std::to_string(wanted) + ", " + why,
                     row.place);
}

/// An integer of TOML: decimal, 0x, 0o or 0b, with underscores; it fits 64 bits.
convex::Fraction exact_integer(const TomlValue& value) {
  std::string digits = value.text;
  std::erase(digits, '_');
  if (digits.starts_with('+')) digits.erase(0, 1);
  int base = 10;
  if (digits.size() > 2 && digits[0] == '0') {
    const char mark = digits[1];
    base = mark == 'x' ? 16 : mark == 'o' ? 8 : mark == 'b' ? 2 : 10;
    if (base != 10) digits.erase(0, 2);
  }
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, base);
  convex::invariant(error == std::errc() && end == digits.data() + digits.size(),
                    "an integer of TOML is written as one");
  return {number, 1};
}

convex::Fraction require_exact(const TomlValue& value, const std::string& where) {
  const double rounded = require_number(value, where);
  if (value.kind == TomlValue::Kind::integer) return exact_integer(value);
  if (!value.is_string()) return convex::fraction(rounded);
  const convex::Fraction exact = *convex::read_fraction(value.text);
  if (rounded == 0 && !exact.numerator.is_zero())
    throw InvalidInput(where + ": " + shown(value.text) + " is too small for a double; choose other units",
                       value.place);
  return exact;
}

}  // namespace

const TomlValue& require_array(const TomlValue& value, const std::string& where) {
  if (value.kind != TomlValue::Kind::array)
    throw InvalidInput(where + ": not a list; write " + where + " = [ … ]", value.place);
  return value;
}

Vector read_vector(const TomlValue& value, const std::string& where) {
  const auto& list = require_array(value, where).array;
  Vector x(static_cast<Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i)
    x[static_cast<Index>(i)] = require_number(list[i], where + "[" + std::to_string(i) + "]");
  return x;
}

convex::RowMatrix read_matrix(const TomlValue& value, const std::string& where, Index columns,
                              const std::string& why) {
  const auto& rows = require_array(value, where).array;
  convex::RowMatrix M(static_cast<Index>(rows.size()), columns);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string row = where + "[" + std::to_string(i) + "]";
    const Vector x = read_vector(rows[i], row);
    require_entries(rows[i], row, x.size(), columns, why);
    M.row(static_cast<Index>(i)) = x;
  }
  return M;
}

convex::ExactVector read_exact_vector(const TomlValue& value, const std::string& where) {
  const auto& list = require_array(value, where).array;
  std::vector<convex::Fraction> entries;
  for (std::size_t i = 0; i < list.size(); ++i)
    entries.push_back(require_exact(list[i], where + "[" + std::to_string(i) + "]"));
  return convex::exact_vector(entries);
}

convex::ExactRows read_exact_matrix(const TomlValue& value, const std::string& where, Index columns,
                                    const std::string& why) {
  const auto& rows = require_array(value, where).array;
  convex::ExactRows M;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string row = where + "[" + std::to_string(i) + "]";
    M.push_back(read_exact_vector(rows[i], row));
    require_entries(rows[i], row, M.back().size(), columns, why);
  }
  return M;
}

}  // namespace cli::inline problem_files
