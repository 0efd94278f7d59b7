#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mechanics::expression {

/// What to write where an expression calls a function that there is not: the way to say it here ("x^p" for
/// pow(x, p)), the function it is a slip of, or which functions there are.
std::string instead_of_function(std::string_view unknown);

/// What to write for a character that expressions do not have: ">=" for "≥".
std::string instead_of_character(std::string_view character);

/// What to write for a relation by which two things differ, "!=", "<>" and "≠".
inline constexpr const char* instead_of_unequal =
    ">= or <= for the side that is allowed (within if also > or <)";

/// The names whose velocity may be meant: "x" for xdot, x_dot, dx or v_x.
std::vector<std::string> names_behind_velocity(std::string_view unknown);

}  // namespace mechanics::expression
