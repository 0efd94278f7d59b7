#pragma once

#include <string>
#include <string_view>

namespace mechanics::expression {

/// What to write where an expression calls a function that there is not: the way to say it here ("x^p" for
/// pow(x, p)), the function it is a slip of, or which functions there are.
std::string instead_of_function(std::string_view unknown);

}  // namespace mechanics::expression
