#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace convex {

/// A number of things as a message says it: "1 entry", "2 entries".
std::string counted(std::integral auto n, std::string_view one, std::string_view many) {
  return std::to_string(n) + " " + std::string(n == 1 ? one : many);
}

}  // namespace convex
