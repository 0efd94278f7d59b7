#pragma once

#include <string_view>

#include "convex/exact/fraction.hpp"
#include "convex/gamma0/call.hpp"

namespace cli::inline function_language {

/// Calls are nested at most this deep.
inline constexpr int deepest_call = 256;

/// Reads a set, function or operation, `name(arguments)`: arguments by position or key=value, each a number
/// (2, 1/3, inf), a vector [1, 2], a matrix [[1, 2], [3, 4]] or another call. Every call and argument of the
/// result knows its place. `what` names the text in messages; `begin` is where it begins in its file. Throws
/// InvalidInput "what: what is wrong; what to do" with the place.
convex::Call parse_call(std::string_view text, std::string_view what, convex::Place begin = {});

/// The same; what is wrong with any of its names, and those of arguments, is told at once.
convex::Call parse_known_call(std::string_view text, std::string_view what, convex::Place begin = {});

/// Reads a vector that stands alone.
convex::Vector parse_vector(std::string_view text, std::string_view what, convex::Place begin = {});

/// A vector that is a point: it has entries, and they are finite; where one is not, its place is told.
convex::Vector parse_point(std::string_view text, std::string_view what);

/// The numbers of a list that has been read, as they are written: "0.1" is a tenth. Of a vector, row by row
/// of a matrix.
std::vector<convex::Fraction> written_numbers(std::string_view list);

}  // namespace cli::inline function_language
