#include "cli/problem_file/numbers.hpp"

#include <algorithm>
#include <set>

#include "cli/problem_file/keys.hpp"
#include "convex/counted.hpp"
#include "convex/mistakes.hpp"

namespace cli::inline problem_files {

using convex::Index;
using convex::InvalidInput;
using convex::Vector;

namespace {

/// Refuses a row of a wrong length, the first of that length: `told` has those before.
void require_entries(const TomlValue& row, const std::string& where, Index wanted, const std::string& why,
                     std::set<Index>& told) {
  const Index found = entries_of(&row);
  if (found < 0 || found == wanted || !told.insert(found).second) return;  // of no list that is told
  throw InvalidInput(where + ": " + convex::counted(found, "entry", "entries") + "; give " +
                         std::to_string(wanted) + ", " + why,
                     row.place);
}

/// Does the work for each entry of a list; what is wrong with any is told at once.
template <class Work>
void for_each_entry(const TomlValue& value, const std::string& where, const Work& work) {
  const auto& list = require_array(value, where).array;
  convex::Mistakes mistakes;
  for (std::size_t i = 0; i < list.size(); ++i)
    mistakes.gather([&] { work(i, list[i], where + "[" + std::to_string(i) + "]"); });
  mistakes.tell();
}

}  // namespace

Index entries_of(const TomlValue* list) {
  const bool is_list = list != nullptr && list->kind == TomlValue::Kind::array;
  return is_list ? static_cast<Index>(list->array.size()) : -1;
}

Index length_of(const TomlValue* vector) {
  const bool has_rows = entries_of(vector) > 0 && entries_of(&vector->array.front()) >= 0;
  return has_rows ? -1 : entries_of(vector);
}

const TomlValue& require_array(const TomlValue& value, const std::string& where) {
  if (value.kind != TomlValue::Kind::array)
    throw InvalidInput(where + ": not a list; write " + where + " = [ … ]", value.place);
  return value;
}

void require_rows(const TomlValue& value, const std::string& where, const std::string& other) {
  const bool is_list = value.kind == TomlValue::Kind::array;
  const auto is_row = [](const TomlValue& row) { return row.kind == TomlValue::Kind::array; };
  if (is_list && (value.array.empty() || std::any_of(value.array.begin(), value.array.end(), is_row))) return;
  throw InvalidInput(where + ": " + (is_list ? "numbers where rows stand" : "no list of rows") +
                         "; write a list for each row, " + where + " = [[2, 0], [0, 1]], or " + other,
                     value.place);
}

Vector read_vector(const TomlValue& value, const std::string& where) {
  Vector x(entries_of(&require_array(value, where)));
  for_each_entry(value, where, [&](std::size_t i, const TomlValue& entry, const std::string& name) {
    x[static_cast<Index>(i)] = require_number(entry, name);
  });
  return x;
}

convex::RowMatrix read_matrix(const TomlValue& value, const std::string& where, Index columns,
                              const std::string& why) {
  const auto& rows = require_array(value, where).array;
  if (columns < 0) columns = rows.empty() ? 0 : std::max<Index>(0, entries_of(&rows.front()));
  convex::RowMatrix M(static_cast<Index>(rows.size()), columns);
  std::set<Index> told;
  for_each_entry(value, where, [&](std::size_t i, const TomlValue& row, const std::string& name) {
    convex::Mistakes mistakes;
    mistakes.gather([&] { require_entries(row, name, columns, why, told); });
    mistakes.gather([&] {
      const Vector x = read_vector(row, name);
      if (x.size() == columns) M.row(static_cast<Index>(i)) = x;
    });
    mistakes.tell();
  });
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
  std::vector<convex::Fraction> entries;
  for_each_entry(value, where, [&](std::size_t, const TomlValue& entry, const std::string& name) {
    entries.push_back(read_exact_number(entry, name));
  });
  return convex::exact_vector(entries);
}

convex::ExactRows read_exact_matrix(const TomlValue& value, const std::string& where, Index columns,
                                    const std::string& why) {
  convex::ExactRows M;
  std::set<Index> told;
  for_each_entry(value, where, [&](std::size_t, const TomlValue& row, const std::string& name) {
    convex::Mistakes mistakes;
    mistakes.gather([&] { require_entries(row, name, columns, why, told); });
    mistakes.gather([&] { M.push_back(read_exact_vector(row, name)); });
    mistakes.tell();
  });
  return M;
}

}  // namespace cli::inline problem_files
