#pragma once

#include <string>

#include "convex/gamma0/function.hpp"

namespace cli::inline reports {

/// The conjugate of a function for which the language has no name, in words, such as "-n - log det(...)"; ""
/// where none is known. `entries` is their number; the product is the plain one.
std::string conjugate_formula(const convex::Call& f, convex::Index entries);

}  // namespace cli::inline reports
