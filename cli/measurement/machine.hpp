#pragma once

#include <string>

namespace cli::inline measurement {

/// The processor, its number, the system and the compiler, in one line: what a time was measured on.
std::string machine_text();

}  // namespace cli::inline measurement
