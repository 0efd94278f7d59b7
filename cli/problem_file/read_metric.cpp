#include "cli/problem_file/read_metric.hpp"

#include <algorithm>

#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/matrix_market.hpp"
#include "cli/problem_file/numbers.hpp"
#include "convex/counted.hpp"

namespace cli::inline problem_files {
namespace {

using convex::Index;
using convex::InvalidInput;
using convex::Metric;

Metric from_rows(const TomlValue& value, const MetricKey& key) {
  require_rows(value, key.key,
               value.is_string() ? key.key + " = { matrix_market = \"" + shown(value.text) + "\" } for a file"
                                 : key.key + " = { diagonal = [2, 1] }");
  const convex::RowMatrix W = read_matrix(value, key.key, key.n, key.why);
  if (W.rows() != key.n)
    throw InvalidInput(key.key + ": " + std::to_string(W.rows()) + (W.rows() == 1 ? " row" : " rows") +
                           "; give " + std::to_string(key.n) + ", " + key.why,
                       value.place);
  return Metric::dense(W);
}

Metric from_table(const TomlValue& value, const MetricKey& key) {
  require_known_keys(value, key.table + "." + key.key, {"diagonal", "matrix_market"});
  if (const TomlValue* diagonal = value.find("diagonal")) {
    if (value.table.size() > 1)
      throw InvalidInput(key.key + ": both diagonal and matrix_market; give one", value.place);
    const convex::Vector d = read_vector(*diagonal, key.key + ".diagonal");
    if (d.size() != key.n)
      throw InvalidInput(key.key + ".diagonal: " + convex::counted(d.size(), "entry", "entries") + "; give " +
                             std::to_string(key.n) + ", " + key.why,
                         diagonal->place);
    return Metric::diagonal(d);
  }
  const TomlValue* file = value.find("matrix_market");
  if (file == nullptr)
    throw InvalidInput(
        key.key + ": an empty table; give diagonal = […] or matrix_market = \"" + key.key + ".mtx\"",
        value.place);
  const convex::SparseMatrix W = read_matrix_file(*file, key.key, key.directory, key.n, key.n);
  constexpr Index small = 200;  // a small matrix is dense whatever its file
  return key.n <= small && W.nonZeros() > key.n ? Metric::dense(convex::Matrix(W)) : Metric::sparse(W);
}

/// Throws where a number of the diagonal is 0 as a double alone.
void refuse_lost_diagonal(const TomlValue& value, const MetricKey& key) {
  const TomlValue* diagonal = value.find("diagonal");
  for (std::size_t i = 0; i < static_cast<std::size_t>(key.n); ++i) {
    const std::string place = "[" + std::to_string(i) + "]";
    if (value.kind == TomlValue::Kind::array)
      read_exact_number(value.array[i].array[i], key.key + place + place);
    else if (diagonal != nullptr)
      read_exact_number(diagonal->array[i], key.key + ".diagonal" + place);
  }
}

}  // namespace

Metric read_metric(const TomlValue& value, const MetricKey& key) {
  try {
    return value.kind == TomlValue::Kind::table ? from_table(value, key) : from_rows(value, key);
  } catch (const InvalidInput& error) {
    if (error.place()) throw;
    refuse_lost_diagonal(value, key);
    throw InvalidInput(metric_message(error.what(), key.key), value.place);
  }
}

std::string matrix_file(const TomlValue& file, const std::string& where, const std::string& directory) {
  const std::string& name = require_string(file, where + ".matrix_market");
  if (std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20U; }))
    throw InvalidInput(where + ": a file name with control characters; name the matrix file", file.place);
  return name.empty() || name[0] == '/' || directory.empty() ? name : directory + "/" + name;
}

convex::SparseMatrix read_matrix_file(const TomlValue& file, const std::string& where,
                                      const std::string& directory, Index rows, Index columns) {
  try {
    return read_matrix_market(matrix_file(file, where, directory), rows, columns);
  } catch (const InvalidInput& error) {
    throw InvalidInput(where + ": " + error.what(), file.place);
  }
}

std::string metric_message(const std::string& message, const std::string& where) {
  if (where == "A") return message;
  std::string text = message.starts_with("A: ") ? where + message.substr(1) : message;
  for (std::size_t at = text.find(" A["); at != std::string::npos; at = text.find(" A[", at + 1))
    text.replace(at + 1, 1, where);
  return text;
}

}  // namespace cli::inline problem_files
