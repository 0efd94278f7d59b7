#pragma once

#include "cli/function_language/cursor.hpp"
#include "convex/gamma0/call.hpp"

namespace cli::inline function_language {

/// A vector or matrix, and its numbers as they were written, row by row.
struct WrittenList {
  convex::Argument value;
  std::vector<std::string> written;
  std::vector<convex::Place> places = {};  ///< where these numbers stand
};

/// Takes a list: of numbers, a vector [1, 2]; of such lists, the rows of a matrix [[1, 2], [3, 4]]. An empty
/// list is a vector. Throws InvalidInput when rows differ in length.
WrittenList take_list(Cursor& cursor);

}  // namespace cli::inline function_language
