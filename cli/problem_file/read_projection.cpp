#include <algorithm>

#include "cli/problem_file/exact_projection.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/numbers.hpp"
#include "cli/problem_file/read_metric.hpp"
#include "cli/problem_file/tables.hpp"

namespace cli::inline problem_files {
namespace {

using convex::Index;
using convex::InvalidInput;
using convex::Vector;

convex::ConstraintRows read_rows(const TomlValue* value, const std::string& directory, Index n) {
  if (value == nullptr) return convex::ConstraintRows(convex::RowMatrix(0, n));
  if (value->kind != TomlValue::Kind::table)
    return convex::ConstraintRows(
        read_matrix(*value, "U", n, "one per coordinate (z has " + std::to_string(n) + ")"));
  require_known_keys(*value, "projection.U", {"matrix_market"});
  const TomlValue* file = value->find("matrix_market");
  if (file == nullptr) throw InvalidInput("U: an empty table; give matrix_market = \"U.mtx\"", value->place);
  const convex::SparseMatrix U = read_matrix_file(*file, "U", directory, -1, n);
  return convex::ConstraintRows(convex::SparseRows(U));
}

std::vector<Index> row_indices(const TomlValue* value, Index m) {
  std::vector<Index> rows;
  if (value == nullptr) return rows;
  for (const TomlValue& entry : require_array(*value, "two_sided").array) {
    if (entry.kind != TomlValue::Kind::integer || entry.number < 0 || entry.number >= static_cast<double>(m))
      throw InvalidInput(
          "two_sided: " +
              (entry.kind == TomlValue::Kind::boolean ? std::string(entry.boolean ? "true" : "false")
                                                      : shown(entry.text)) +
              " is no row of U; " +
              (m == 0 ? std::string("U has none") : "rows are integers from 0 to " + std::to_string(m - 1)),
          entry.place);
    rows.push_back(static_cast<Index>(entry.number));
  }
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

ProjectionProblem read_projection(const TomlValue& table, const std::string& directory) {
  require_known_keys(table, "projection", {"A", "z", "U", "s", "two_sided"});
  const TomlValue *A = table.find("A"), *z = table.find("z"), *U = table.find("U"), *s = table.find("s");
  if (A == nullptr || z == nullptr)
    throw InvalidInput(std::string("projection: ") +
                           (A != nullptr   ? "z is missing; give"
                            : z != nullptr ? "A is missing; give"
                                           : "A and z are missing; give both,") +
                           " the n×n matrix A and the n numbers of z",
                       table.place);
  const Vector force = read_vector(*z, "z");
  const Index n = force.size();
  convex::ConstraintRows rows = read_rows(U, directory, n);
  if (s == nullptr && rows.count() > 0)
    throw InvalidInput("s is missing; give one number per row of U: " + std::to_string(rows.count()),
                       U->place);
  const Vector bound = s == nullptr ? Vector(0) : read_vector(*s, "s");
  if (bound.size() != rows.count())
    throw InvalidInput("s: " + std::to_string(bound.size()) + " entries; give " +
                           std::to_string(rows.count()) + ", one per row of U",
                       s == nullptr ? table.place : s->place);
  try {
    return {{read_inertia(*A, {"projection", "A", directory, n, "one per entry of z"}), force, rows, bound,
             row_indices(table.find("two_sided"), rows.count())}};
  } catch (const InvalidInput& error) {
    throw InvalidInput(error.what(), error.place().value_or(A->place));
  }
}

}  // namespace cli::inline problem_files
