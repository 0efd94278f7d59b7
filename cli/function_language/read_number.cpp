#include "cli/function_language/read_number.hpp"

#include <cctype>
#include <cmath>
#include <limits>

#include "cli/problem_file/exact_number.hpp"
#include "cli/problem_file/keys.hpp"

namespace cli::inline function_language {
namespace {

bool infinity_begins(const Cursor& cursor, std::size_t ahead) {
  constexpr std::string_view word = "inf";
  for (std::size_t i = 0; i < word.size(); ++i)
    if (cursor.peek(ahead + i) != word[i]) return false;
  const char after = cursor.peek(ahead + word.size());
  return !begins_name(after) && !is_digit(after);
}

/// The length of digits[.digits][e[+-]digits] from `ahead` on; 0 when there is no digit.
std::size_t decimal_length(const Cursor& cursor, std::size_t ahead) {
  std::size_t at = ahead, digits = 0;
  const auto take_digits = [&] {
    for (; is_digit(cursor.peek(at)); ++at) ++digits;
  };
  take_digits();
  if (cursor.peek(at) == '.') {
    ++at;
    take_digits();
  }
  if (digits == 0) return 0;
  if (cursor.peek(at) == 'e' || cursor.peek(at) == 'E') {
    const std::size_t sign = cursor.peek(at + 1) == '+' || cursor.peek(at + 1) == '-' ? 1 : 0;
    if (is_digit(cursor.peek(at + 1 + sign))) {
      at += 1 + sign;
      take_digits();
    }
  }
  return at - ahead;
}

}  // namespace

bool number_begins(const Cursor& cursor) {
  const char sign = cursor.peek();
  const std::size_t ahead = sign == '-' || sign == '+' ? 1 : 0;
  const char c = cursor.peek(ahead);
  return is_digit(c) || c == '.' || infinity_begins(cursor, ahead);
}

void refuse_word_of_no_number(const Cursor& cursor) {
  const std::size_t first = cursor.peek() == '-' || cursor.peek() == '+' ? 1 : 0;
  std::string word, small;
  for (std::size_t i = first; begins_name(cursor.peek(i)); ++i) word += cursor.peek(i);
  for (const char c : word) small += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (small == "nan") cursor.fail(word + " is not finite; give a number");
  if (small == "inf" || small == "infinity")
    cursor.fail("\"" + word + "\" is no number; an infinite one is inf or -inf");
}

WrittenNumber take_number(Cursor& cursor) {
  const convex::Place place = cursor.place();
  const bool negative = cursor.peek() == '-';
  const std::size_t sign = negative || cursor.peek() == '+' ? 1 : 0;
  if (infinity_begins(cursor, sign)) {
    cursor.advance(sign + 3);
    cursor.skip_spaces();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (negative) return {-infinity, "-inf"};
    return {infinity, "inf"};
  }
  std::size_t length = decimal_length(cursor, sign);
  if (length == 0) {
    cursor.advance(sign);
    cursor.fail("no number at " + cursor.shown_next() + "; write 2, -0.5, 1e-3, 1/3, inf or -inf");
  }
  if (cursor.peek(sign + length) == '/') {
    const std::size_t denominator = decimal_length(cursor, sign + length + 1);
    if (denominator > 0) length += 1 + denominator;
  }
  std::string digits;
  for (std::size_t i = 0; i < sign + length; ++i) digits += cursor.peek(i);
  cursor.advance(sign + length);
  if (begins_name(cursor.peek()))
    cursor.fail(cursor.shown_next() + " right behind a number; write 2, -0.5, 1e-3, 1/3, inf or -inf");
  cursor.skip_spaces();
  const std::optional<double> value = nearest_double(digits);
  if (!value)
    cursor.fail("the denominator of " + shown(digits) + " is 0; write another number, or inf", place);
  if (!std::isfinite(*value))
    cursor.fail("the number " + shown(digits) + " is too large for a double; choose other units", place);
  return {*value, std::move(digits)};
}

}  // namespace cli::inline function_language
