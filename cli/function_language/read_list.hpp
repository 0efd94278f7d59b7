#pragma once

#include "cli/function_language/cursor.hpp"
#include "convex/gamma0/call.hpp"

namespace cli {

/// Takes a list: of numbers, a vector [1, 2]; of such lists, the rows of a matrix [[1, 2], [3, 4]]. An empty
/// list is a vector. Throws InvalidInput when rows differ in length.
convex::Argument take_list(Cursor& cursor);

}  // namespace cli
