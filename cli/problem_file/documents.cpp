#include "cli/problem_file/documents.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "cli/held_interrupt.hpp"
#include "cli/problem_file/exact_number.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/matrix_market.hpp"
#include "cli/problem_file/problem.hpp"
#include "cli/problem_file/read_metric.hpp"
#include "cli/problem_file/tables.hpp"
#include "cli/problem_file/write_projection.hpp"

namespace cli::inline problem_files {
namespace {

using convex::Index;
using convex::InvalidInput;
namespace fs = std::filesystem;

TomlValue decimal_value(const std::string& text) {
  TomlValue value;
  value.kind =
      text.find_first_of(".eE") == std::string::npos ? TomlValue::Kind::integer : TomlValue::Kind::floating;
  value.number = std::strtod(text.c_str(), nullptr);
  value.text = text;
  // What neither TOML nor JSON reads as a number, .5 or 1e400, is written by its double.
  const std::string digits = text[0] == '-' ? text.substr(1) : text;
  const bool leads = digits.size() > 1 && digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9';
  const std::size_t point = digits.find('.');
  const bool bare_point =
      point == 0 || (point != std::string::npos &&
                     (point + 1 == digits.size() || digits[point + 1] < '0' || digits[point + 1] > '9'));
  if (leads || bare_point) value.text = fmt::format("{}", value.number);
  return value;
}

TomlValue list_value(const std::vector<std::string>& numbers) {
  TomlValue list;
  list.kind = TomlValue::Kind::array;
  for (const std::string& number : numbers) list.array.push_back(decimal_value(number));
  return list;
}

TomlValue rows_value(const std::vector<std::vector<std::string>>& rows) {
  TomlValue list;
  list.kind = TomlValue::Kind::array;
  for (const auto& row : rows) list.array.push_back(list_value(row));
  return list;
}

using Digits = std::vector<std::vector<std::string>>;

/// Puts the numbers of matrix files in the place of their names, where `are_chosen` says so of a file and the
/// size that it is to have.
void write_out(TomlValue& document, const std::string& directory,
               bool (*are_chosen)(const std::string& path, Index rows, Index columns)) {
  for (TomlEntry& content : document.table) {
    const TomlValue* z = content.value.find("z");
    if (z == nullptr || z->kind != TomlValue::Kind::array) continue;
    const auto n = static_cast<Index>(z->array.size());
    for (TomlEntry& entry : content.value.table) {
      const TomlValue* file = entry.value.find("matrix_market");
      if (file == nullptr) continue;
      const Index rows = entry.key == "U" ? -1 : n;
      try {
        const std::string path = matrix_file(*file, entry.key, directory);
        if (!are_chosen(path, rows, n)) continue;
        TomlValue numbers = rows_value(read_matrix_digits(path, rows, n));
        numbers.place = file->place;
        entry.value = std::move(numbers);
      } catch (const InvalidInput& error) {
        throw InvalidInput(error.place() ? error.what() : entry.key + ": " + error.what(), file->place);
      }
    }
  }
}

convex::SparseRows column_of(const convex::Vector& x) {
  convex::SparseRows column(x.size(), 1);
  for (Index i = 0; i < x.size(); ++i)
    if (x[i] != 0) column.insert(i, 0) = x[i];
  return column;
}

}  // namespace

DocumentForm form_of(const std::string& file) {
  const auto ends_with = [&](const std::string& ending) {
    return file.size() >= ending.size() &&
           file.compare(file.size() - ending.size(), ending.size(), ending) == 0;
  };
  if (ends_with(".json")) return DocumentForm::json;
  if (ends_with(".qps") || ends_with(".QPS") || ends_with(".mps")) return DocumentForm::qps;
  if (ends_with(".mtx") || ends_with(".mtx/")) return DocumentForm::matrix_market;
  std::error_code error;
  if (fs::is_directory(file, error) && fs::exists(file + "/z.mtx", error)) return DocumentForm::matrix_market;
  return DocumentForm::toml;
}

TomlValue read_document(const std::string& file) {
  switch (form_of(file)) {
    case DocumentForm::json:
      return parse_json(read_file(file));
    case DocumentForm::qps:
      return parse_qps(read_file(file));
    case DocumentForm::matrix_market:
      return read_matrix_folder(file);
    default:
      break;
  }
  const std::string text = read_file(file);
  // Standard input has no name to tell the form by; no TOML begins with a brace.
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool is_json = file == "-" && first != std::string::npos && text[first] == '{';
  return is_json ? parse_json(text) : parse_toml(text);
}

TomlValue projection_document(const std::vector<std::vector<std::string>>& A,
                              const std::vector<std::string>& z,
                              const std::vector<std::vector<std::string>>& U,
                              const std::vector<std::string>& s, const std::vector<std::size_t>& two_sided) {
  TomlValue projection;
  projection.table.push_back({"A", {}, rows_value(A)});
  projection.table.push_back({"z", {}, list_value(z)});
  projection.table.push_back({"U", {}, rows_value(U)});
  projection.table.push_back({"s", {}, list_value(s)});
  if (!two_sided.empty()) {
    std::vector<std::string> rows;
    for (const std::size_t row : two_sided) rows.push_back(std::to_string(row));
    projection.table.push_back({"two_sided", {}, list_value(rows)});
  }
  TomlValue document;
  document.table.push_back({"projection", {}, std::move(projection)});
  return document;
}

TomlValue read_matrix_folder(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InvalidInput("no folder of Matrix Market files; give one with A.mtx, z.mtx, U.mtx and s.mtx");
  const Digits z = read_matrix_digits(folder + "/z.mtx", -1, 1);
  const auto n = static_cast<Index>(z.size());
  const Digits A = read_matrix_digits(folder + "/A.mtx", n, n);
  Digits U, s;
  convex::Matrix two_sided(0, 1);
  if (fs::exists(folder + "/U.mtx", error)) U = read_matrix_digits(folder + "/U.mtx", -1, n);
  if (fs::exists(folder + "/s.mtx", error))
    s = read_matrix_digits(folder + "/s.mtx", static_cast<Index>(U.size()), 1);
  if (fs::exists(folder + "/two_sided.mtx", error))
    two_sided = read_matrix_market(folder + "/two_sided.mtx", -1, 1);
  std::vector<std::size_t> rows;
  for (Index k = 0; k < two_sided.rows(); ++k) rows.push_back(static_cast<std::size_t>(two_sided(k, 0)));
  const auto column = [](const Digits& M) {
    std::vector<std::string> numbers;
    for (const auto& row : M) numbers.push_back(row.front());
    return numbers;
  };
  return projection_document(A, column(z), U, column(s), rows);
}

void write_matrices_out(TomlValue& document, const std::string& directory) {
  write_out(document, directory, [](const std::string&, Index, Index) { return true; });
}

void write_long_integers_out(TomlValue& document, const std::string& directory) {
  write_out(document, directory, holds_long_integers);
}

void write_file(const std::string& file, const std::string& text) {
  const HeldInterrupt held;
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw InvalidInput("cannot write " + shown(file) + "; check its folder and permissions");
}

void write_problem_folder(const convex::NearestPointProblem& problem, const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder))
    throw InvalidInput("cannot make the folder " + shown(folder) + "; check its place and permissions");
  const auto write = [&](const char* name, const convex::SparseRows& M) {
    write_file(folder + "/" + name, matrix_market_text(M));
  };
  const Index n = problem.dimension();
  convex::Matrix U(problem.rows(), n);
  for (Index a = 0; a < problem.rows(); ++a) U.row(a) = problem.U.row(a);
  write("A.mtx", convex::SparseRows(full_gram(problem.A).sparseView(0, 0)));
  write("z.mtx", column_of(problem.z));
  write("U.mtx", convex::SparseRows(U.sparseView(0, 0)));
  write("s.mtx", column_of(problem.s));
  fs::remove(folder + "/two_sided.mtx", error);
  if (problem.two_sided.empty()) return;
  std::string text =
      fmt::format("%%MatrixMarket matrix array integer general\n{} 1\n", problem.two_sided.size());
  for (const Index row : problem.two_sided) text += fmt::format("{}\n", row);
  write_file(folder + "/two_sided.mtx", text);
}

convex::Matrix full_gram(const convex::Metric& A) {
  if (A.kind() == convex::MetricKind::dense) return A.dense_gram();
  if (A.kind() == convex::MetricKind::sparse) return convex::Matrix(A.sparse_gram());
  return A.diagonal().asDiagonal();
}

void write_matrix_folder(const TomlValue& document, const std::string& folder) {
  for (const TomlEntry& entry : document.table)
    if (entry.key != "projection" && entry.key != "title")
      throw InvalidInput("[" + shown(entry.key) +
                             "] cannot be held by .mtx files, which have A, z, U and s alone" +
                             (entry.key == "system" ? "; `moreau derive --mtx` writes those of a mechanism"
                                                    : "; take it out, or choose .toml or .json"),
                         entry.place);
  const TomlValue* table = document.find("projection");
  if (table == nullptr) throw InvalidInput("no [projection] here; .mtx files hold one");
  for (const char* key : {"A", "z", "U", "s"})
    if (const TomlValue* value = table->find(key)) require_doubles(*value, key, ".mtx");
  const ProjectionProblem checked = read_projection(*table, "");
  write_problem_folder(checked.problem, folder);
}

}  // namespace cli::inline problem_files
