#pragma once

#include <source_location>

namespace convex {

/// Stops the program with file and line when `holds` is false: a defect of this program, never of its input.
/// It stays on in Release.
void invariant(bool holds, const char* claim, std::source_location where = std::source_location::current());

}  // namespace convex
