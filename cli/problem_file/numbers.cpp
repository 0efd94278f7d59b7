#include "cli/problem_file/numbers.hpp"

#include "cli/problem_file/keys.hpp"

namespace cli {

using convex::Index;
using convex::InvalidInput;
using convex::Vector;

namespace {

/// The metric's complaint in the file's words: its matrix is called A there, and is an inertia.
std::string in_words_of(const std::string& where, std::string message) {
  if (where == "A") return message;
  if (message.starts_with("A: ")) message = where + message.substr(1);
  for (std::size_t at = message.find(" A["); at != std::string::npos; at = message.find(" A[", at + 1))
    message.replace(at + 1, 1, where);
  const std::string advice = "; every motion must have";
  if (const std::size_t at = message.find(advice); at != std::string::npos)
    message = message.substr(0, at) + "; give a symmetric positive definite matrix";
  return message;
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
    if (x.size() != columns)
      throw InvalidInput(row + ": " + std::to_string(x.size()) + (x.size() == 1 ? " entry" : " entries") +
                             "; give " + std::to_string(columns) + ", " + why,
                         rows[i].place);
    M.row(static_cast<Index>(i)) = x;
  }
  return M;
}

convex::Metric read_metric(const TomlValue& value, const std::string& where, Index n,
                           const std::string& why) {
  const convex::RowMatrix W = read_matrix(value, where, n, why);
  if (W.rows() != n)
    throw InvalidInput(where + ": " + std::to_string(W.rows()) + (W.rows() == 1 ? " row" : " rows") +
                           "; give " + std::to_string(n) + ", " + why,
                       value.place);
  try {
    return convex::Metric::dense(W);
  } catch (const InvalidInput& error) {
    throw InvalidInput(in_words_of(where, error.what()), value.place);
  }
}

}  // namespace cli
