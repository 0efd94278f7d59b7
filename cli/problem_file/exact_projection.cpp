#include "cli/problem_file/exact_projection.hpp"

#include <algorithm>
#include <limits>

#include "cli/problem_file/exact_number.hpp"
#include "cli/problem_file/numbers.hpp"
#include "convex/exact/positive_definite.hpp"
#include "convex/nearest_point/solution.hpp"

namespace cli::inline problem_files {
namespace {

using convex::ExactRows;
using convex::Index;

bool is_symmetric(const std::vector<TomlValue>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < i && j < rows[i].array.size(); ++j)
      if (rows[i].array[j].number != rows[j].array[i].number) return false;
  return true;
}

/// The doubles of U as they are.
ExactRows rows_of(const convex::ConstraintRows& U) {
  ExactRows rows;
  for (Index a = 0; a < U.count(); ++a) rows.push_back(convex::exact_vector(U.row(a)));
  return rows;
}

convex::Matrix gram(const convex::Metric& A) {
  if (A.kind() == convex::MetricKind::dense) return A.dense_gram();
  if (A.kind() == convex::MetricKind::sparse) return convex::Matrix(A.sparse_gram());
  return A.diagonal().asDiagonal();
}

ExactRows diagonal_rows(const convex::ExactVector& d) {
  ExactRows rows;
  for (std::size_t i = 0; i < d.numerators.size(); ++i) {
    std::vector<convex::Fraction> row(d.numerators.size());
    row[i] = convex::entry(d, i);
    rows.push_back(convex::exact_vector(row));
  }
  return rows;
}

ExactRows inertia(const TomlValue& value, const convex::Metric& rounded) {
  if (value.kind != TomlValue::Kind::table) return read_exact_matrix(value, "A", rounded.dimension(), "");
  if (const TomlValue* diagonal = value.find("diagonal"))
    return diagonal_rows(read_exact_vector(*diagonal, "A.diagonal"));
  return convex::exact_rows(gram(rounded));
}

}  // namespace

bool is_made_of_doubles(const TomlValue& table) {
  for (const char* key : {"A", "z", "U", "s"}) {
    const TomlValue* value = table.find(key);
    if (value != nullptr && value->kind == TomlValue::Kind::table) value = value->find("diagonal");
    if (value != nullptr && !is_double(*value)) return false;
  }
  const TomlValue* A = table.find("A");
  return A == nullptr || is_symmetric(A->array);
}

convex::DataRadii rounded_rows(const TomlValue& table, const convex::NearestPointProblem& problem) {
  convex::DataRadii radii = convex::rounding_radii(problem, 1);  // each number was rounded once
  const auto clear = [&](const char* key, convex::Vector& of) {
    const TomlValue* value = table.find(key);
    const bool in_file = value == nullptr || value->kind == TomlValue::Kind::table;
    for (Index a = 0; a < of.size(); ++a)
      if (in_file || is_double(value->array[static_cast<std::size_t>(a)])) of[a] = 0;
  };
  clear("U", radii.row);
  clear("s", radii.s);
  return radii;
}

std::optional<convex::Metric> metric_as_written(const TomlValue& A, const MetricKey& key) {
  if (convex::cholesky_work(key.n, std::numeric_limits<double>::digits) > convex::most_word_operations)
    return std::nullopt;
  try {
    ExactRows rows;
    if (A.kind != TomlValue::Kind::table) {
      rows = read_exact_matrix(A, key.key, key.n, key.why);
    } else if (const TomlValue* file = A.find("matrix_market")) {
      rows =
          convex::exact_rows(convex::Matrix(read_matrix_file(*file, key.key, key.directory, key.n, key.n)));
    }
    if (static_cast<Index>(rows.size()) != key.n) return std::nullopt;
    const convex::ExactProblem exact = convex::exact_problem_of_definite(
        rows, convex::exact_vector(convex::Vector(convex::Vector::Zero(key.n))), {}, {}, {});
    const auto L = convex::cholesky_factor(exact.A, convex::most_word_operations);
    if (!L) return std::nullopt;
    convex::Matrix W(key.n, key.n);
    for (Index i = 0; i < key.n; ++i) W.col(i) = convex::nearest({exact.A[convex::at(i)], exact.unit});
    const convex::Matrix factor = *L / std::sqrt(convex::nearest_quotient(exact.unit, 1));
    const bool is_ordinary = W.allFinite() && factor.allFinite() && factor.diagonal().minCoeff() > 0x1p-500;
    return is_ordinary ? std::optional(convex::Metric::dense(W, factor)) : std::nullopt;
  } catch (const convex::InvalidInput&) {
    return std::nullopt;
  }
}

convex::ExactProblem read_exact_projection(const TomlValue& table,
                                           const convex::NearestPointProblem& rounded) {
  const TomlValue *A = table.find("A"), *U = table.find("U"), *s = table.find("s");
  const bool rows_in_file = U != nullptr && U->kind == TomlValue::Kind::table;
  try {
    return convex::exact_problem(inertia(*A, rounded.A), read_exact_vector(*table.find("z"), "z"),
                                 U == nullptr   ? ExactRows{}
                                 : rows_in_file ? rows_of(rounded.U)
                                                : read_exact_matrix(*U, "U", rounded.dimension(), ""),
                                 s == nullptr ? convex::ExactVector{} : read_exact_vector(*s, "s"),
                                 rounded.two_sided);
  } catch (const convex::InvalidInput& error) {
    throw convex::InvalidInput(error.what(), error.place().value_or(A->place));
  }
}

}  // namespace cli::inline problem_files
