#pragma once

#include "cli/function_language/cursor.hpp"

namespace cli {

/// Does a number begin here: a digit, a point, a sign, or inf?
bool number_begins(const Cursor& cursor);

/// Takes a number: 2, -0.5, 1e-3, 1/3 (rounded once), inf, -inf. Throws InvalidInput.
double take_number(Cursor& cursor);

}  // namespace cli
