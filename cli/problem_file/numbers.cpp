#include "cli/problem_file/numbers.hpp"

#include "cli/problem_file/keys.hpp"

namespace cli {

using convex::Index;
using convex::InvalidInput;
using convex::Vector;

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
    if (x.size() != columns)
      throw InvalidInput(row + ": " + std::to_string(x.size()) + (x.size() == 1 ? " entry" : " entries") +
                             "; give " + std::to_string(columns) + ", " + why,
                         rows[i].place);
    M.row(static_cast<Index>(i)) = x;
  }
  return M;
}

}  // namespace cli
