#pragma once

#include <string>

namespace mechanics {

/// A number in six significant digits, for messages.
std::string number_text(double x);

}  // namespace mechanics
