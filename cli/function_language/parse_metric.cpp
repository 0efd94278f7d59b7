#include "cli/function_language/parse_metric.hpp"

#include "cli/function_language/cursor.hpp"
#include "cli/function_language/parse_call.hpp"
#include "cli/function_language/read_list.hpp"
#include "cli/problem_file/read_metric.hpp"

namespace cli::inline function_language {
namespace {

constexpr const char* metric_form = "a matrix, [[2, 1], [1, 2]], or a diagonal, \"diagonal [1, 2]\"";

}  // namespace

convex::Metric parse_metric(std::string_view text) {
  constexpr const char* what = "metric";
  Cursor cursor(text, what, {});
  cursor.skip_spaces();
  const convex::Place place = cursor.place();
  const std::string_view word = cursor.take_name();
  cursor.skip_spaces();
  if ((!word.empty() && word != "diagonal") || cursor.peek() != '[')
    cursor.fail(std::string("neither a matrix nor a diagonal; write ") + metric_form, place);
  const convex::Argument list = take_list(cursor).value;
  if (!cursor.at_end()) cursor.fail(cursor.shown_next() + " behind the end; write " + metric_form);
  try {
    const auto* diagonal = std::get_if<convex::Vector>(&list);
    if (word.empty() && diagonal == nullptr) return convex::Metric::dense(std::get<convex::Matrix>(list));
    if (!word.empty() && diagonal != nullptr) return convex::Metric::diagonal(*diagonal);
  } catch (const convex::InvalidInput& error) {
    throw convex::InvalidInput(metric_message(error.what(), what), place);
  }
  cursor.fail(
      std::string(word.empty() ? "a vector" : "a matrix behind \"diagonal\"") + "; write " + metric_form,
      place);
}

convex::ExactGram parse_exact_metric(std::string_view text) {
  const std::size_t list = text.find('[');
  const std::vector<convex::Fraction> numbers = written_numbers(text.substr(list));
  const bool is_diagonal = text.find_first_not_of(" \t\n\r") != list;
  std::size_t n = numbers.size();
  if (!is_diagonal) n = static_cast<std::size_t>(parse_metric(text).dimension());
  std::vector<convex::Fractions> rows(n, convex::Fractions(n));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (!is_diagonal || i == j) rows[i][j] = convex::lowest_terms(numbers[is_diagonal ? i : i * n + j]);
  return convex::exact_gram(rows);
}

}  // namespace cli::inline function_language
