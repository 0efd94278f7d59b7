#pragma once

#include <string>

#include "convex/gamma0/function.hpp"

namespace cli::inline function_language {

/// Where f, on n entries, is finite: "everywhere", a set of the language, or words made of such; "" when no
/// rule says.
std::string domain_text(const convex::Function& f, convex::Index n);

}  // namespace cli::inline function_language
