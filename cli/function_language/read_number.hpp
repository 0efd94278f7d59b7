#pragma once

#include <string>

#include "cli/function_language/cursor.hpp"

namespace cli::inline function_language {

/// Does a number begin here: a digit, a point or inf, with a sign before it or without?
bool number_begins(const Cursor& cursor);

/// Throws InvalidInput where a word for what is no number stands here: nan, Infinity, …
void refuse_word_of_no_number(const Cursor& cursor);

/// A number as it was written, and the double nearest to it.
struct WrittenNumber {
  double value = 0;
  std::string text;
};

/// Takes a number: 2, -0.5, 1e-3, 1/3 (rounded once), inf, -inf. Throws InvalidInput.
WrittenNumber take_number(Cursor& cursor);

}  // namespace cli::inline function_language
