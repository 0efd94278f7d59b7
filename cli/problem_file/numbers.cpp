#include "cli/problem_file/numbers.hpp"

#include "cli/problem_file/keys.hpp"

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

convex::Fraction read_exact_number(const TomlValue& value, const std::string& where) {
  const double rounded = require_number(value, where);
  if (value.kind == TomlValue::Kind::floating) return convex::fraction(rounded);
  convex::Fraction exact = *convex::read_fraction(value.text);
  if (rounded == 0 && !exact.numerator.is_zero())
    throw InvalidInput(where + ": " + shown(value.text) + " is too small for a double; choose other units",
                       value.place);
  return exact;
}

convex::ExactVector read_exact_vector(const TomlValue& value, const std::string& where) {
  const auto& list = require_array(value, where).array;
  std::vector<convex::Fraction> entries;
  for (std::size_t i = 0; i < list.size(); ++i)
    entries.push_back(read_exact_number(list[i], where + "[" + std::to_string(i) + "]"));
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
