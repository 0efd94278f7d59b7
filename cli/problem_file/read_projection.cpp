#include <algorithm>

#include "cli/problem_file/exact_projection.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/kinds.hpp"
#include "cli/problem_file/numbers.hpp"
#include "cli/problem_file/read_metric.hpp"
#include "cli/problem_file/tables.hpp"
#include "convex/counted.hpp"

namespace cli::inline problem_files {
namespace {

using convex::Index;
using convex::InvalidInput;
using convex::Vector;

constexpr const char* as_the_first = "as many as the first row has";

/// Of n = -1, where z tells no number of coordinates, the numbers alone.
convex::ConstraintRows read_rows(const TomlValue* value, const std::string& directory, Index n) {
  if (value == nullptr) return convex::ConstraintRows(convex::RowMatrix(0, std::max<Index>(0, n)));
  if (value->kind != TomlValue::Kind::table) {
    require_rows(*value, "U",
                 value->is_string() ? "U = { matrix_market = \"" + shown(value->text) + "\" } for a file"
                                    : "U = { matrix_market = \"U.mtx\" }");
    return convex::ConstraintRows(read_matrix(
        *value, "U", n, n < 0 ? as_the_first : "one per coordinate (z has " + std::to_string(n) + ")"));
  }
  require_known_keys(*value, "projection.U", {"matrix_market"});
  const TomlValue* file = value->find("matrix_market");
  if (file == nullptr) throw InvalidInput("U: an empty table; give matrix_market = \"U.mtx\"", value->place);
  const convex::SparseMatrix U = read_matrix_file(*file, "U", directory, -1, n);
  return convex::ConstraintRows(convex::SparseRows(U));
}

/// m = -1: it is not known how many rows there are.
std::vector<Index> row_indices(const TomlValue* value, Index m) {
  std::vector<Index> rows;
  if (value == nullptr) return rows;
  convex::Mistakes mistakes;
  for (const TomlValue& entry : require_array(*value, "two_sided").array) {
    if (entry.kind == TomlValue::Kind::integer && entry.number >= 0 &&
        (m < 0 || entry.number < static_cast<double>(m))) {
      rows.push_back(static_cast<Index>(entry.number));
      continue;
    }
    const bool is_truth = entry.kind == TomlValue::Kind::boolean;
    const std::string there_are = m < 0    ? "rows are integers from 0 on"
                                  : m == 0 ? "U has none"
                                  : m == 1 ? "its only row is 0"
                                           : "rows are integers from 0 to " + std::to_string(m - 1);
    mistakes.add(InvalidInput(
        "two_sided: " + (is_truth ? std::string(entry.boolean ? "true" : "false") : shown(entry.text)) +
            " is no row of U; " + there_are,
        entry.place));
  }
  mistakes.tell();
  std::sort(rows.begin(), rows.end());
  const auto twice = std::adjacent_find(rows.begin(), rows.end());
  if (twice != rows.end())
    throw InvalidInput("two_sided: row " + std::to_string(*twice) + " twice; list each row once",
                       value->place);
  return rows;
}

convex::Metric read_inertia(const TomlValue& A, const MetricKey& key) {
  try {
    return read_metric(A, key);
  } catch (const InvalidInput&) {
    if (std::optional<convex::Metric> metric = metric_as_written(A, key)) return *std::move(metric);
    throw;
  }
}

}  // namespace

ProjectionProblem read_projection(const TomlValue& given, const std::string& directory) {
  convex::Mistakes mistakes;
  const MeantTable meant(given, "projection", projection_keys, mistakes);
  const TomlValue& table = meant.table();
  const TomlValue *A = table.find("A"), *z = table.find("z"), *U = table.find("U"), *s = table.find("s");
  if ((A == nullptr || z == nullptr) && meant.is_whole())
    mistakes.add(InvalidInput(std::string("projection: ") +
                                  (A != nullptr   ? "z is missing; give"
                                   : z != nullptr ? "A is missing; give"
                                                  : "A and z are missing; give both,") +
                                  " the n×n matrix A and the n numbers of z",
                              table.place));
  const Index n = length_of(z);  // known where its numbers are wrong, too
  Index m = U == nullptr && meant.is_whole() ? 0 : entries_of(U);
  Vector force, bound;
  convex::ConstraintRows rows;
  std::optional<convex::Metric> inertia;
  std::vector<Index> two_sided;
  if (z != nullptr) mistakes.gather([&] { force = read_vector(*z, "z"); });
  if (n >= 0 || entries_of(U) >= 0)  // a matrix file is read by the number of coordinates
    mistakes.gather([&] {
      rows = read_rows(U, directory, n);
      if (U != nullptr) m = rows.count();
    });
  if (s != nullptr) mistakes.gather([&] { bound = read_vector(*s, "s"); });
  if (s == nullptr && m > 0 && meant.is_whole())
    mistakes.add(InvalidInput("s is missing; give one number per row of U: " + std::to_string(m), U->place));
  const Index bounds = entries_of(s);
  if (m >= 0 && bounds >= 0 && bounds != m)
    mistakes.add(InvalidInput("s: " + convex::counted(bounds, "entry", "entries") + "; give " +
                                  std::to_string(m) + ", one per row of U",
                              s->place));
  mistakes.gather([&] { two_sided = row_indices(table.find("two_sided"), m); });
  if (A != nullptr && n < 0 && entries_of(A) >= 0)
    mistakes.gather([&] { read_matrix(*A, "A", -1, as_the_first); });
  if (A != nullptr && n >= 0)
    mistakes.gather([&] {
      try {
        inertia = read_inertia(*A, {"projection", "A", directory, n, "one per entry of z"});
      } catch (const InvalidInput& error) {
        throw error.place() ? error : InvalidInput(error.what(), A->place);
      }
    });
  mistakes.tell();
  return {{*std::move(inertia), force, rows, bound, two_sided}};
}

}  // namespace cli::inline problem_files
