#pragma once

#include "convex/gamma0/call.hpp"

namespace cli::inline function_language {

/// The number n of entries of x in a call when nothing else tells it: a size that its vectors and matrices
/// suggest and that the call accepts, else 3, else the least up to 64. When it accepts none, the first
/// suggestion: making the function in it says what is wrong.
convex::Index number_of_entries(const convex::Call& call);

}  // namespace cli::inline function_language
